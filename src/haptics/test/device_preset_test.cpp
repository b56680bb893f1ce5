#include "haptics/device_preset.h"

#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "core/data_dir.h"
#include "core/temporary_folder.h"
#include "haptics/test/layered_patient.h"

namespace trocar {
namespace {

const std::filesystem::path kFile = data_dir() / "devices.toml";

TEST(DevicePreset, DefaultOfASceneIsThePremium) {
  const auto premium = load_device_preset(kFile, "premium");
  ASSERT_TRUE(premium) << premium.error().text();
  constexpr DeviceCapability kDefault;
  EXPECT_EQ(premium->capability.peak_force_n, kDefault.peak_force_n);
  EXPECT_EQ(premium->capability.peak_torque_nmm, kDefault.peak_torque_nmm);
  EXPECT_EQ(premium->capability.max_stiffness_n_per_mm, kDefault.max_stiffness_n_per_mm);
  EXPECT_EQ(premium->capability.stylus_weight_n, kDefault.stylus_weight_n);
  EXPECT_EQ(premium->capability.stylus_lever_mm, kDefault.stylus_lever_mm);
  EXPECT_NEAR(premium->encoder.count_mm, 25.4 / 860.0, 5e-5);
  HapticOptions options;
  apply_device_preset(*premium, options);
  constexpr HapticOptions kOptions;
  EXPECT_EQ(options.coupling.stiffness_n_per_mm, kOptions.coupling.stiffness_n_per_mm);
  EXPECT_EQ(options.coupling.damping_ns_per_mm, kOptions.coupling.damping_ns_per_mm);
  EXPECT_EQ(options.constraint.force_n, kOptions.constraint.force_n);
}

TEST(DevicePreset, EveryDeviceMakesAScene) {
  const auto presets = load_device_presets(kFile);
  ASSERT_TRUE(presets) << presets.error().text();
  EXPECT_GE(presets->size(), 8u);
  for (const DevicePreset& preset : *presets) {
    EXPECT_FALSE(preset.title.empty());
    EXPECT_EQ(preset.has_torque(), preset.actuated_dof == 6) << preset.name;
    EXPECT_EQ(preset.encoder.count_rad > 0.0, preset.sensed_dof == 6) << preset.name;
    HapticOptions options;
    apply_device_preset(preset, options);
    const auto scene = make_haptic_scene(testing::layered_patient(testing::liver_way()), testing::paper_tissues(), {},
                                         preset.capability, options);
    EXPECT_TRUE(scene) << preset.name << ": " << scene.error().text();
  }
}

TEST(DevicePreset, UnknownNameListsTheKnownOnes) {
  const auto preset = load_device_preset(kFile, "touch");
  ASSERT_FALSE(preset);
  EXPECT_EQ(preset.error().exit_status, 2);
  EXPECT_NE(preset.error().advice.find("omni"), std::string::npos);
}

TEST(DevicePreset, ImpossibleDeviceIsRefused) {
  const std::string good = *read_file(kFile);
  const TemporaryFolder folder;
  const auto path = folder / "devices.toml";
  const auto is_refused = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    EXPECT_TRUE(write_file_atomically(path, text));
    return !load_device_presets(path);
  };
  EXPECT_FALSE(is_refused("title", "title"));
  EXPECT_TRUE(is_refused("sensed_dof = 6", "sensed_dof = 5"));
  EXPECT_TRUE(is_refused("actuated_dof = 6", "actuated_dof = 3"));  // and has torques
  EXPECT_TRUE(is_refused("peak_force_n = ", "peek_force_n = "));
  EXPECT_TRUE(is_refused("peak_force_n = {value = 37.5", "peak_force_n = {value = 3750"));
  EXPECT_TRUE(is_refused("continuous_force_n = {value = 6.2", "continuous_force_n = {value = 62"));  // above the peak
  EXPECT_TRUE(is_refused("coupling_stiffness_n_per_mm = {value = 1", "coupling_stiffness_n_per_mm = {value = 9"));
}

}  // namespace
}  // namespace trocar
