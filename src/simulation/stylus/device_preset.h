#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"

namespace trocar::stylus {

/// Sensing and limits of a device. Defaults: PHANTOM Premium 1.5 High Force 6DOF (paper B, section 2.1).
struct DeviceCapability {
  double peak_force_n = 37.5;
  double peak_torque_nmm = 515.0;       ///< 0: senses rotation but has no torque.
  double peak_roll_nmm = 170.0;         ///< Torque about the stylus' own axis; 0: as the peak torque.
  double max_stiffness_n_per_mm = 3.5;  ///< Range 0.1..20. Source: vendor's nominal figure, references.md.
  double stylus_weight_n = 0.5;         ///< Weight of links and stylus on the hand. Range 0..5. [assumed]
  double stylus_lever_mm = 20.0;        ///< Centre of that weight behind the stylus origin, along -z of S. [assumed]

  bool has_torque() const noexcept { return peak_torque_nmm > 0.0; }
};

/// Spring and damper between device and virtual needle (physics.md V1). Range: stiffness at most the device's. Values:
/// references.md, steady within 0.3 N on a bare 45-150 g mass.
struct CouplingParams {
  double stiffness_n_per_mm = 1.0;
  double damping_ns_per_mm = 0.003;

  /// Springs at the pose so far ahead in time damp in proportion to their stiffness (physics.md B7).
  double damping_time_s() const noexcept { return damping_ns_per_mm / stiffness_n_per_mm; }
};

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

/// Force (N) and torque (N mm) that the device can hold for long; a fifth and three tenths of the peaks where no value
/// is known [assumed].
double continuous_force_n(const DevicePreset& preset) noexcept;
double continuous_torque_nmm(const DevicePreset& preset) noexcept;
double continuous_roll_nmm(const DevicePreset& preset) noexcept;  ///< About the stylus' own axis.

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

}  // namespace trocar::stylus
