#pragma once

#include "geometry/pose.h"
#include "scene/camera.h"
#include "ui_kit/window_mirror.h"

namespace trocar::trainer {

/// A workstation with a mirror between eye and hands (paper B): how the monitor's image is mirrored, and the pose of
/// its image in the mirror, so that the virtual tool is drawn at the hand. Lengths in W, the frame of the room: x to
/// the user's right, y away from the user, z up, origin in the middle of the device's workspace (base_mm of
/// data/devices.toml moves the device there).
struct MirrorSettings {
  MirrorAxis axis = MirrorAxis::kNone;
  bool is_camera_fixed = false;    ///< Camera of the 3D view at the eye; else set by the user.
  Vec3 picture_W = Vec3::Zero();   ///< Centre of the window's image in the mirror, mm. Range -500..500 each.
  double tilt_deg = 45.0;          ///< 0: upright in front of the user; 90: horizontal, seen from above. Range 0..90.
  double screen_width_mm = 520.0;  ///< Width of the screen's image in the mirror. Range 100..2000.
  double eye_distance_mm = 600.0;  ///< From the eye to the image. Range 200..2000.
};

/// Loads the stored settings, each clamped to its range; the default width is the one reported by the screen.
MirrorSettings load_mirror_settings();
void save_mirror_settings(const MirrorSettings& settings);

/// Position of a view in the window, pixels.
struct ViewPlace {
  double right_px = 0.0, down_px = 0.0;  ///< From the window's centre to the view's centre.
  int rows = 1;
  double mm_per_pixel = 0.25;  ///< In the mirror.
};
/// Camera in W (although its fields are named P). Its image in the mirror has every point of the room on the line from
/// the eye to that point: a tool is seen at its true position. The eye is in front of the view's centre.
scene::CameraView mirror_camera_W(const MirrorSettings& settings, const ViewPlace& place) noexcept;
/// The same camera in P.
scene::CameraView moved(const Pose& X_PW, const scene::CameraView& view_W) noexcept;

}  // namespace trocar::trainer
