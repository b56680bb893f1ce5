#include "haptics/scene_options.h"

#include <gtest/gtest.h>

namespace trocar {
namespace {

TEST(SceneOptions, ReadBackToTheSameValues) {
  HapticScene scene;
  scene.options.force_model = ForceModel::kCombined;
  scene.options.coupling = {0.1 + 0.2, 1.0 / 3.0};
  scene.options.constraint.force_n = 2.7;
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

}  // namespace
}  // namespace trocar
