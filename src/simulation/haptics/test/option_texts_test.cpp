#include "haptics/option_texts.h"

#include <gtest/gtest.h>

#include "haptics/test/layered_patient.h"

namespace trocar::haptics {
namespace {

TEST(SceneOptions, RoundTrip) {
  HapticScene scene;
  scene.options.force_model = ForceModel::kCombined;
  scene.options.coupling = {0.1 + 0.2, 1.0 / 3.0};
  scene.options.has_bending = false;
  scene.device.peak_force_n = 7.9;
  scene.device.stylus_lever_mm = -12.5;
  HapticOptions options;
  stylus::DeviceCapability device;
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

TEST(SceneOptions, RefuseUnknownKeysAndBadValues) {
  for (const char* bad : {"coupling.stiffness", "coupling.stiffness=", "coupling.stiffness=nan", "bending=yes",
                          "device.peak_force=1e999", "colour=1", "force_model=magic", ""}) {
    HapticOptions options;
    stylus::DeviceCapability device;
    const std::vector<std::string> texts{bad};
    const Status status = restore_options(texts, options, device);
    ASSERT_FALSE(status) << bad;
    EXPECT_EQ(status.error().exit_status, 2);
  }
}

TEST(HapticScene, UsesThePathConstraintOfAFittedTable) {
  const auto patient = testing::layered_patient(testing::liver_way());
  anatomy::TissueTable tissues = testing::paper_tissues();
  const auto of_program = make_haptic_scene(patient, tissues, {}, {}, {});
  ASSERT_TRUE(of_program);
  EXPECT_EQ((*of_program)->options.constraint.force_n, PathConstraintParams{}.force_n);
  tissues.path_constraint = {true, 1.5, 40.0};
  const auto fitted = make_haptic_scene(patient, tissues, {}, {}, {});
  ASSERT_TRUE(fitted) << fitted.error().text();
  EXPECT_EQ((*fitted)->options.constraint.force_n, 1.5);
  EXPECT_EQ((*fitted)->options.constraint.torque_nmm, 40.0);
  // No more than the device renders: 1 N/mm over d_0 = 3 mm, and no torque without motors for it.
  tissues.path_constraint = {true, 20.0, 40.0};
  stylus::DeviceCapability weak;
  weak.max_stiffness_n_per_mm = 1.0;
  weak.peak_torque_nmm = 0.0;
  const auto limited = make_haptic_scene(patient, tissues, {}, weak, {});
  ASSERT_TRUE(limited) << limited.error().text();
  EXPECT_EQ((*limited)->options.constraint.force_n, 1.0 * PathConstraintParams{}.linear_mm);
  EXPECT_EQ((*limited)->options.constraint.torque_nmm, 0.0);
}

TEST(HapticScene, TreatsUnknownTissuesAsSoftTissueWithAWarning) {
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
