#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/result.h"
#include "geometry/pose.h"
#include "geometry/vec.h"
#include "stylus/device_preset.h"

namespace trocar::devices {

/// Pose of the device in the room, and the mapping of its motion and force to the patient.
struct WorkspaceParams {
  Pose X_WD;                  ///< Device base in the room (calibration).
  double motion_scale = 1.0;  ///< Patient mm per device mm. Range 0.1..10.
  double force_scale = 1.0;   ///< Device N per patient N, for devices weaker than the force peaks. Range 0.01..1.
  std::uint32_t clutch = 0;   ///< Button bits of the clutch; while pressed, the device moves without moving the tool.
                              ///< 0: none.
};
/// Workspace parameters of a preset from data/devices.toml.
WorkspaceParams workspace_params(const stylus::DevicePreset& preset) noexcept;

/// State of the clutch. The clutch moves the base and rotates the tool in the hand. It never rotates the base, so that
/// the vertical and the directions of forces are kept.
struct WorkspaceState {
  Pose X_WD_now;                     ///< X_WD moved by the clutch.
  Mat3 R_SS_now = Mat3::Identity();  ///< Displayed stylus in the held stylus, rotated by the clutch.
  Pose X_WS_held;                    ///< Displayed pose when the clutch was pressed.
  bool is_started = false;
  bool is_clutched = false;
};

/// X_WS of a reading, with the motion scaled about the origin of the device; constant while the clutch is pressed. A
/// non-finite reading is returned unchanged and does not change the clutch. Real-time safe.
Pose map_to_room(WorkspaceState& state, const WorkspaceParams& params, const Pose& X_DS,
                 std::uint32_t buttons) noexcept;

/// Inverse of map_to_room() for a released clutch: the X_DS that maps to X_WS. Real-time safe.
Pose map_from_room(const WorkspaceState& state, const WorkspaceParams& params, const Pose& X_WS) noexcept;

/// Rotates and scales a wrench in W about S into D; zero while the clutch is pressed. Do not use it for the
/// compensation of the device's own weight. Real-time safe.
Wrench map_to_device(const WorkspaceState& state, const WorkspaceParams& params, const Wrench& wrench_W) noexcept;

/// Converts a wrench about S for a device without torque: the axial force is kept, and the lateral force at S has
/// the moment about the entry point that force and torque have together (physics.md G10). `p_SE`: vector from S to the
/// entry point; empty outside the body, and then the force is unchanged. If the lever is shorter than kLeastLever_mm,
/// the share of the torque decreases to zero with the lever. `axis`: unit vector of the needle. All arguments are in
/// one frame. Do not use it for the weight compensation of the stylus. Real-time safe.
Wrench without_torque(const Wrench& wrench, const Vec3& axis, const std::optional<Vec3>& p_SE) noexcept;
inline constexpr double kLeastLever_mm = 20.0;

/// Weight of the stylus of one device, measured by its user (server/stylus_weighing). It replaces that of the preset in
/// the weight compensation.
struct StylusProfile {
  std::string device;              ///< HapticDevice::name(): "openhaptics:Left Device".
  std::string preset;              ///< Row of data/devices.toml of the weighed device: "omni".
  double weight_n = 0.0;           ///< Range 0..5.
  std::optional<double> lever_mm;  ///< As DeviceCapability::stylus_lever_mm; absent: the preset's. Range -200..200.
};

/// File of a device's profile: its name, other characters than letters, digits, '-' and '_' as %XX.
std::filesystem::path stylus_profile_file(const std::filesystem::path& folder, const std::string& device);
/// Writes the profile completely or not at all; makes the folder. Replaces an earlier one of the device. Errors: a
/// number out of range, the disk.
Status save_stylus_profile(const StylusProfile& profile, const std::filesystem::path& folder);
/// Removes the profile of a device; false if there was none. Error: the disk.
Result<bool> remove_stylus_profile(const std::filesystem::path& folder, const std::string& device);
/// Empty if there is no profile. Errors name file and key: no valid TOML, an unknown key, a number that is not finite
/// or out of range, a profile of another device.
Result<std::optional<StylusProfile>> load_stylus_profile(const std::filesystem::path& folder,
                                                         const std::string& device);
/// The preset with the weight of the device's profile, unchanged without a profile or with an empty `folder`. Errors:
/// those of load_stylus_profile, a profile of another preset, a weight above the device's continuous force.
Result<stylus::DevicePreset> with_stylus_profile(stylus::DevicePreset preset, const std::filesystem::path& folder,
                                                 const std::string& device);

}  // namespace trocar::devices
