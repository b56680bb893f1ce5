#pragma once

#include <cstdint>

#include "geometry/pose.h"
#include "geometry/wrench.h"
#include "haptics/coupling/device_preset.h"

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
WorkspaceParams workspace_params(const haptics::DevicePreset& preset) noexcept;

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

}  // namespace trocar::devices
