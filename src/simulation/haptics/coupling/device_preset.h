#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"
#include "haptics/closed_loop/encoder.h"
#include "haptics/haptic_scene.h"

namespace trocar::haptics {

/// A haptic device as data (data/devices.toml): what it can do, and the coupling we use with it.
struct DevicePreset {
  std::string name;
  std::string title;
  int sensed_dof = 6;                        ///< 3: position only, the needle keeps its direction; 6: also orientation.
  int actuated_dof = 6;                      ///< 0: no force (display only); 3: forces only; 6: also torques.
  double workspace_radius_mm = 100.0;        ///< Range 10..1000.
  DeviceCapability capability;               ///< Peak values; peak torque 0 without torque.
  std::optional<double> continuous_force_n;  ///< Where it could be found. Range 0.1..200.
  std::optional<double> continuous_torque_nmm;
  EncoderParams encoder;
  double apparent_mass_kg = 0.1;         ///< At the stylus. Range 0.01..2.
  double friction_n = 0.1;               ///< Coulomb friction of its joints, felt at the stylus. Range 0..2.
  double viscosity_ns_per_mm = 0.0005;   ///< Viscous friction, likewise. Range 0..0.05.
  CouplingParams coupling;               ///< Stiffness at most the device's.
  double max_damping_ns_per_mm = 0.003;  ///< Damper that it can show in a loop of 1 kHz. Range 0..0.1.
  double force_scale = 1.0;              ///< Device newtons a patient newton. Range 0.01..1.
  double motion_scale = 1.0;             ///< Patient mm a device mm. Range 0.1..10.
  int clutch_button = 0;                 ///< 1, 2: clutch button; 0: none.
  Pose X_WD;                             ///< Calibration: its base in the room.

  bool has_torque() const noexcept { return capability.peak_torque_nmm > 0.0; }
  /// false for a mouse or gamepad. Peak and stiffness are then those of the displayed force.
  bool has_force() const noexcept { return actuated_dof > 0; }
};

/// All devices of the file, in its order. Errors name file, line and key.
Result<std::vector<DevicePreset>> load_device_presets(const std::filesystem::path& path);
/// Unknown name: exit status 2, the message lists the names.
Result<DevicePreset> load_device_preset(const std::filesystem::path& path, std::string_view name);

/// Limits of a scene in patient newtons and millimetres that keep the device within its own limits: peaks and weight
/// divided by force_scale, stiffness by both scales.
DeviceCapability scene_capability(const DevicePreset& preset) noexcept;

/// What a scene for this device needs: its coupling, and no constraint stiffer than it.
void apply_device_preset(const DevicePreset& preset, HapticOptions& options) noexcept;

}  // namespace trocar::haptics
