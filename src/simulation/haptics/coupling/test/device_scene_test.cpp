#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "anatomy/tissue/tissue_table.h"
#include "core/files/folders.h"
#include "haptics/option_texts.h"
#include "haptics/test/layered_patient.h"
#include "stylus/device_preset.h"

namespace trocar::haptics {
namespace {

const std::filesystem::path kFile = data_dir() / "devices.toml";

TEST(DeviceScene, CouplingLimitsThePathSpring) {
  for (const char* name : {"premium", "omega6", "falcon"}) {
    const auto preset = stylus::load_device_preset(kFile, name);
    ASSERT_TRUE(preset) << preset.error().text();
    HapticOptions options;
    apply_device_preset(*preset, options);
    EXPECT_EQ(options.coupling.stiffness_n_per_mm, preset->coupling.stiffness_n_per_mm);
    EXPECT_EQ(options.coupling.damping_ns_per_mm, preset->coupling.damping_ns_per_mm);
    EXPECT_LE(options.constraint.force_n, preset->coupling.stiffness_n_per_mm * options.constraint.linear_mm);
    EXPECT_LE(options.constraint.force_n, HapticOptions{}.constraint.force_n);
  }
}

TEST(DeviceScene, EveryDeviceMakesAScene) {
  const auto presets = stylus::load_device_presets(kFile);
  ASSERT_TRUE(presets) << presets.error().text();
  EXPECT_GE(presets->size(), 8u);
  for (const stylus::DevicePreset& preset : *presets) {
    EXPECT_FALSE(preset.title.empty());
    EXPECT_EQ(preset.has_torque(), preset.actuated_dof == 6) << preset.name;
    EXPECT_EQ(preset.encoder.count_rad > 0.0, preset.sensed_dof == 6) << preset.name;
    HapticOptions options;
    apply_device_preset(preset, options);
    for (const stylus::DeviceCapability& capability : {preset.capability, stylus::scene_capability(preset)}) {
      const auto scene = make_haptic_scene(testing::layered_patient(testing::liver_way()), testing::paper_tissues(), {},
                                           capability, options);
      EXPECT_TRUE(scene) << preset.name << ": " << scene.error().text();
    }
  }
}

TEST(DeviceScene, ForcesOfTissuesAreScaledIntoTheDevice) {
  const auto presets = stylus::load_device_presets(kFile);
  const auto table = anatomy::load_tissue_table(data_dir() / "tissues.toml");
  ASSERT_TRUE(presets && table);
  double strongest_n = 0.0;
  for (const anatomy::LayerParams& layer : table->layers) {
    if (std::isfinite(layer.puncture_force_n)) strongest_n = std::max(strongest_n, layer.puncture_force_n);
  }
  const auto skin = table->find_layer("skin");
  ASSERT_TRUE(skin);
  const double skin_n = table->layers[*skin].puncture_force_n;
  constexpr double kShareOfPeak = 0.8;  // data/devices.toml: friction and path want the rest
  int scaled = 0;
  for (const stylus::DevicePreset& preset : *presets) {
    EXPECT_LE(strongest_n * preset.force_scale, kShareOfPeak * preset.capability.peak_force_n + 1e-9) << preset.name;
    if (preset.continuous_force_n) {
      EXPECT_LE(skin_n * preset.force_scale, *preset.continuous_force_n) << preset.name;
    }
    scaled += preset.force_scale < 1.0 ? 1 : 0;
  }
  EXPECT_GE(scaled, 1);
}

}  // namespace
}  // namespace trocar::haptics
