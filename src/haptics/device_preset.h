#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "haptics/haptic_scene.h"
#include "haptics/simulation/encoder.h"

namespace trocar {

/// A haptic device as data (data/devices.toml): what it can do, and the coupling we use with it.
struct DevicePreset {
  std::string name;
  std::string title;
  int sensed_dof = 6;                        ///< 3: position alone, the needle keeps its direction; 6: also the angles.
  int actuated_dof = 6;                      ///< 3: forces alone; 6: also torques.
  double workspace_radius_mm = 100.0;        ///< Range 10..1000.
  DeviceCapability capability;               ///< Peak values; peak torque 0 without torque.
  std::optional<double> continuous_force_n;  ///< Where it could be found. Range 0.1..200.
  std::optional<double> continuous_torque_nmm;
  EncoderParams encoder;
  double apparent_mass_kg = 0.1;  ///< At the stylus. Range 0.01..2.
  CouplingParams coupling;        ///< Stiffness at most the device's.

  bool has_torque() const noexcept { return capability.peak_torque_nmm > 0.0; }
};

/// All devices of the file, in its order. Errors name file, line and key.
Result<std::vector<DevicePreset>> load_device_presets(const std::filesystem::path& path);
/// Unknown name: exit status 2, the message lists the names.
Result<DevicePreset> load_device_preset(const std::filesystem::path& path, std::string_view name);

/// What a scene for this device needs: its coupling, and no constraint stiffer than it.
void apply_device_preset(const DevicePreset& preset, HapticOptions& options) noexcept;

}  // namespace trocar
