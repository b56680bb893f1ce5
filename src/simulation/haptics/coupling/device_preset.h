#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"
#include "haptics/haptic_scene.h"

namespace trocar::haptics {

/// Resolution of a device's sensors.
struct EncoderParams {
  double count_mm = 0.0295;   ///< One count of position. Range 0.0001..1; 0: exact.
  double count_rad = 4.0e-5;  ///< One count of an angle. Range 1e-6..0.1; 0: exact.
};

/// Quantised pose: position rounded to counts on every axis, the rotation vector likewise; the error is at most half a
/// count per axis. Real-time safe.
Pose quantise(const Pose& X_DS, const EncoderParams& encoder) noexcept;

/// A haptic device as data (data/devices.toml): its capability, and the coupling used with it.
struct DevicePreset {
  std::string name;
  std::string title;
  int sensed_dof = 6;                        ///< 3: position only, the needle keeps its direction; 6: also orientation.
  int actuated_dof = 6;                      ///< 0: no force (display only); 3: forces only; 6: also torques.
  double workspace_radius_mm = 100.0;        ///< Range 10..1000.
  DeviceCapability capability;               ///< Peak values; peak torque 0 without torque.
  std::optional<double> continuous_force_n;  ///< Absent where no value is known. Range 0.1..200.
  std::optional<double> continuous_torque_nmm;
  std::optional<double> continuous_roll_nmm;  ///< About the stylus' own axis.
  EncoderParams encoder;
  double apparent_mass_kg = 0.1;        ///< Apparent mass at the stylus. Range 0.01..2.
  double friction_n = 0.1;              ///< Coulomb friction of the joints, at the stylus. Range 0..2.
  double viscosity_ns_per_mm = 0.0005;  ///< Viscous friction of the joints, at the stylus. Range 0..0.05.
  CouplingParams coupling;              ///< Its stiffness is at most the device's.
  /// Largest damping that the device can render in a loop of 1 kHz. Range 0..0.1.
  double max_damping_ns_per_mm = 0.003;
  double force_scale = 1.0;   ///< Device newtons per patient newton. Range 0.01..1.
  double motion_scale = 1.0;  ///< Patient mm per device mm. Range 0.1..10.
  int clutch_button = 0;      ///< 1, 2: clutch button; 0: none.
  Pose X_WD;                  ///< Calibration: pose of the device's base in the room.

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

/// Sets the options of a scene for this device: its coupling, and no constraint stiffer than that coupling.
void apply_device_preset(const DevicePreset& preset, HapticOptions& options) noexcept;

/// Limits of a coupling, in the patient's newtons and millimetres.
struct CouplingLimits {
  double most_n_per_mm = 3.5;     ///< Stiffest spring that the device can render.
  double most_ns_per_mm = 0.005;  ///< Largest damping that the device can render at 1 kHz.
  double least_n_per_mm = 0.05;   ///< Lower limit; a softer coupling renders no useful tissue force. [assumed]
  /// Largest ratio of damping to stiffness; B7 and C3 predict the pose by this time. [assumed]
  double longest_s = 0.01;
};

/// Limits of a device: its greatest stiffness and damping, divided by its scales. A device without motors only displays
/// a force and accepts any damping up to that of the defaults above.
CouplingLimits limits_of(const DevicePreset& preset) noexcept;
/// The nearest coupling within the limits; a softer spring keeps its damping time.
CouplingParams within(const CouplingParams& coupling, const CouplingLimits& limits) noexcept;
/// Errors (exit status 2): the first number outside its limits, with the limits. The rotational coupling has no
/// parameters of its own: it equals that of two springs as far apart as the tool is wide (physics.md B9).
Status check(const CouplingParams& coupling, const CouplingLimits& limits);

}  // namespace trocar::haptics
