#pragma once

#include <cstdint>

#include "geometry/pose.h"
#include "haptics/coupling/device_preset.h"
#include "haptics/insertion/path_constraint.h"  // Wrench

namespace trocar::devices {

/// Pose of the device in the room, and the mapping of its motion and force to the patient.
struct WorkspaceParams {
  Pose X_WD;                  ///< Device base in the room (calibration).
  double motion_scale = 1.0;  ///< Patient mm a device mm. Range 0.1..10.
  double force_scale = 1.0;   ///< Device newtons a patient newton, for devices too weak for the peaks. Range 0.01..1.
  std::uint32_t clutch = 0;   ///< Button bits of the clutch; while pressed, the device moves without moving the tool.
                              ///< 0: none.
};
/// What data/devices.toml says of it.
WorkspaceParams workspace_params(const haptics::DevicePreset& preset) noexcept;

/// State of the clutch. It moves the base and rotates the tool in the hand but never rotates the base: up remains up,
/// and a force keeps its direction.
struct WorkspaceState {
  Pose X_WD_now;                     ///< X_WD moved by the clutch.
  Mat3 R_SS_now = Mat3::Identity();  ///< The stylus as shown in the stylus as held, turned by the clutch.
  Pose X_WS_held;                    ///< Where the stylus was when the clutch was pressed.
  bool is_started = false;
  bool is_clutched = false;
};

/// X_WS of a reading, motion scaled about the device's origin; constant while the clutch is pressed. A non-finite
/// reading is returned unchanged and has no effect. Real-time safe.
Pose map_to_room(WorkspaceState& state, const WorkspaceParams& params, const Pose& X_DS,
                 std::uint32_t buttons) noexcept;

/// The other way, without the clutch's hold: the X_DS whose reading is shown at X_WS. Real-time safe.
Pose map_from_room(const WorkspaceState& state, const WorkspaceParams& params, const Pose& X_WS) noexcept;

/// The wrench in D for one in W about S: rotated, scaled; zero while clutched. The compensation of the device's own
/// weight is no patient's force and does not go this way. Real-time safe.
haptics::Wrench map_to_device(const WorkspaceState& state, const WorkspaceParams& params,
                              const haptics::Wrench& wrench_W) noexcept;

}  // namespace trocar::devices
