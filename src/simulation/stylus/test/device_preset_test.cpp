#include "stylus/device_preset.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/files/folders.h"
#include "core/testing/changed_file.h"

namespace trocar::stylus {
namespace {

const std::filesystem::path kFile = data_dir() / "devices.toml";

TEST(DevicePreset, DefaultSceneLimitsAreThoseOfThePremium) {
  const auto premium = load_device_preset(kFile, "premium");
  ASSERT_TRUE(premium) << premium.error().text();
  constexpr DeviceCapability kDefault;
  EXPECT_EQ(premium->capability.peak_force_n, kDefault.peak_force_n);
  EXPECT_EQ(premium->capability.peak_torque_nmm, kDefault.peak_torque_nmm);
  EXPECT_EQ(premium->capability.max_stiffness_n_per_mm, kDefault.max_stiffness_n_per_mm);
  EXPECT_EQ(premium->capability.stylus_weight_n, kDefault.stylus_weight_n);
  EXPECT_EQ(premium->capability.stylus_lever_mm, kDefault.stylus_lever_mm);
  EXPECT_NEAR(premium->encoder.count_mm, 25.4 / 860.0, 5e-5);
}

TEST(DevicePreset, SceneLimitsMatchScaledDeviceLimits) {
  const auto omni = load_device_preset(kFile, "omni");
  ASSERT_TRUE(omni);
  DevicePreset preset = *omni;
  preset.motion_scale = 2.0;
  const DeviceCapability asked = scene_capability(preset);
  EXPECT_NEAR(asked.peak_force_n * preset.force_scale, preset.capability.peak_force_n, 1e-12);
  EXPECT_NEAR(asked.stylus_weight_n * preset.force_scale, preset.capability.stylus_weight_n, 1e-12);
  // One device millimetre is two of the patient; a patient spring of k pulls the device by k * 2 * force_scale.
  EXPECT_NEAR(asked.max_stiffness_n_per_mm * preset.motion_scale * preset.force_scale,
              preset.capability.max_stiffness_n_per_mm, 1e-12);
}

TEST(DevicePreset, PointingDeviceGivesNoForce) {
  for (const char* name : {"mouse", "gamepad", "spacemouse"}) {
    const auto preset = load_device_preset(kFile, name);
    ASSERT_TRUE(preset) << preset.error().text();
    EXPECT_FALSE(preset->has_force()) << name;
    EXPECT_FALSE(preset->has_torque()) << name;
    EXPECT_EQ(preset->capability.stylus_weight_n, 0.0) << name;
  }
  EXPECT_TRUE(load_device_preset(kFile, "omni")->has_force());
}

/// Loads the shipped table with one text replaced.
Result<std::vector<DevicePreset>> load_changed(const std::string& from, const std::string& to) {
  return testing::load_changed(kFile, from, to, [](const auto& file) { return load_device_presets(file); });
}

TEST(DevicePreset, CalibrationPlacesTheBaseInTheRoom) {
  const std::string title = "sensed_dof = 6\nactuated_dof = 6";
  const auto presets = load_changed(title, title +
                                               "\nbase_mm = [100.0, -20.0, 5.0]\nbase_deg = [90.0, 0.0, 90.0]"
                                               "\nclutch_button = 2");
  ASSERT_TRUE(presets) << presets.error().text();
  const DevicePreset& premium = presets->front();
  EXPECT_EQ(premium.clutch_button, 2);
  EXPECT_LT((premium.X_WD.p() - Vec3(100.0, -20.0, 5.0)).norm(), 1e-12);
  // About x first: y becomes z. Then about z: x becomes y.
  EXPECT_LT((premium.X_WD.R() * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_LT((premium.X_WD.R() * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
}

TEST(DevicePreset, WrongMappingNamesFileTableAndKey) {
  const std::string title = "sensed_dof = 6\nactuated_dof = 6\n";
  for (const auto& [line, key] : std::vector<std::pair<std::string, std::string>>{
           {"base_mm = [1.0, 2.0]\n", "base_mm"},
           {"base_deg = [1.0, 2.0, 400.0]\n", "base_deg"},
           {"clutch_button = 3\n", "clutch_button"},
           {"motion_scale = {value = 0.0, source = \"x\"}\n", "motion_scale"},
           {"force_scale = {value = 1.5, source = \"x\"}\n", "force_scale"},
           {"friction_kg = {value = 0.1, source = \"x\"}\n", "friction_kg"}}) {
    const auto presets = load_changed(title, title + line);
    ASSERT_FALSE(presets) << line;
    const std::string text = presets.error().text();
    EXPECT_NE(text.find("devices.toml"), std::string::npos) << text;
    EXPECT_NE(text.find("premium"), std::string::npos) << text;
    EXPECT_NE(text.find(key), std::string::npos) << text;
  }
}

TEST(DevicePreset, UnknownNameListsTheKnownOnes) {
  const auto preset = load_device_preset(kFile, "touch");
  ASSERT_FALSE(preset);
  EXPECT_EQ(preset.error().exit_status, 2);
  EXPECT_NE(preset.error().advice.find("omni"), std::string::npos);
}

TEST(DevicePreset, ImpossibleDeviceIsRefused) {
  const auto is_refused = [](const std::string& from, const std::string& to) { return !load_changed(from, to); };
  EXPECT_FALSE(is_refused("title", "title"));
  EXPECT_TRUE(is_refused("sensed_dof = 6", "sensed_dof = 5"));
  EXPECT_TRUE(is_refused("actuated_dof = 6", "actuated_dof = 3"));  // and has torques
  EXPECT_TRUE(is_refused("peak_force_n = ", "peek_force_n = "));
  EXPECT_TRUE(is_refused("peak_force_n = {value = 37.5", "peak_force_n = {value = 3750"));
  EXPECT_TRUE(is_refused("continuous_force_n = {value = 6.2", "continuous_force_n = {value = 62"));  // above the peak
  EXPECT_TRUE(is_refused("coupling_stiffness_n_per_mm = {value = 1", "coupling_stiffness_n_per_mm = {value = 9"));
}

TEST(DevicePreset, UnknownContinuousForceIsAShareOfThePeak) {
  DevicePreset preset;
  preset.capability.peak_force_n = 10.0;
  preset.capability.peak_torque_nmm = 200.0;
  preset.capability.peak_roll_nmm = 100.0;
  EXPECT_NEAR(continuous_force_n(preset), 2.0, 1e-12);
  EXPECT_NEAR(continuous_torque_nmm(preset), 60.0, 1e-12);
  EXPECT_NEAR(continuous_roll_nmm(preset), 30.0, 1e-12);
  preset.continuous_force_n = 3.0;
  preset.continuous_torque_nmm = 500.0;  // never above the peak
  EXPECT_EQ(continuous_force_n(preset), 3.0);
  EXPECT_EQ(continuous_torque_nmm(preset), 200.0);
}

}  // namespace
}  // namespace trocar::stylus
