#include "haptics/scene_options.h"

#include <gtest/gtest.h>

#include "haptics/test/layered_patient.h"

namespace trocar::haptics {
namespace {

TEST(SceneOptions, ReadBackToTheSameValues) {
  HapticScene scene;
  scene.options.force_model = ForceModel::kCombined;
  scene.options.coupling = {0.1 + 0.2, 1.0 / 3.0};
  scene.options.has_bending = false;
  scene.device.peak_force_n = 7.9;
  scene.device.stylus_lever_mm = -12.5;
  HapticOptions options;
  DeviceCapability device;
  const auto texts = option_texts(scene);
  const Status status = restore_options(texts, options, device);
  ASSERT_TRUE(status) << status.error().text();
  EXPECT_EQ(options.force_model, ForceModel::kCombined);
  EXPECT_EQ(options.coupling.stiffness_n_per_mm, scene.options.coupling.stiffness_n_per_mm);
  EXPECT_EQ(options.coupling.damping_ns_per_mm, scene.options.coupling.damping_ns_per_mm);
  EXPECT_FALSE(options.has_bending);
  EXPECT_TRUE(options.has_stick);
  scene.options = options;
  scene.device = device;
  EXPECT_EQ(option_texts(scene), texts);
}

TEST(SceneOptions, RefuseWhatTheyDoNotKnow) {
  for (const char* bad : {"coupling.stiffness", "coupling.stiffness=", "coupling.stiffness=nan", "bending=yes",
                          "device.peak_force=1e999", "colour=1", "force_model=magic", ""}) {
    HapticOptions options;
    DeviceCapability device;
    const std::vector<std::string> texts{bad};
    const Status status = restore_options(texts, options, device);
    ASSERT_FALSE(status) << bad;
    EXPECT_EQ(status.error().exit_status, 2);
  }
}

TEST(HapticScene, LabelsOfUnknownTissuesCountAsSoftTissueAndAreAllNamed) {
  auto patient = testing::layered_patient(testing::liver_way());
  patient->label_table.labels[0].tissue = "blubber";
  patient->label_table.labels[3].tissue = "horn";
  const anatomy::TissueTable tissues = testing::paper_tissues();
  ::testing::internal::CaptureStderr();
  const auto scene = make_haptic_scene(patient, tissues, {}, {}, {});
  const std::string warning = ::testing::internal::GetCapturedStderr();
  ASSERT_TRUE(scene) << scene.error().text();
  for (const char* part : {"fat (blubber)", "rib (horn)", "soft_tissue"})
    EXPECT_NE(warning.find(part), std::string::npos) << warning;
  EXPECT_EQ((*scene)->tissue_of_label[testing::kFat], *tissues.find_tissue("soft_tissue"));
  EXPECT_EQ((*scene)->tissue_of_label[testing::kLiver], *tissues.find_tissue("liver"));
}

}  // namespace
}  // namespace trocar::haptics
