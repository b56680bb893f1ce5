#pragma once

#include "geometry/pose.h"
#include "scene/camera.h"
#include "ui_kit/window_mirror.h"

namespace trocar::trainer {

/// A workstation with a mirror between eye and hands (paper B): how the monitor is turned over, and where its picture
/// stands in the mirror, so that the virtual tool can be drawn where the hand is. Lengths in W, the room about the
/// device: x to the right of who sits at it, y away, z up, origin in the middle of the device's workspace (base_mm of
/// data/devices.toml moves the device there).
struct MirrorSettings {
  MirrorAxis axis = MirrorAxis::kNone;
  bool is_camera_fixed = false;    ///< The 3D view looks from the eye; else as it is turned.
  Vec3 picture_W = Vec3::Zero();   ///< Middle of the window's picture in the mirror, mm. Range -500..500 each.
  double tilt_deg = 45.0;          ///< 0: it stands upright before the user; 90: it lies, seen from above. 0..90.
  double screen_width_mm = 520.0;  ///< Width of the screen's picture in the mirror. Range 100..2000.
  double eye_distance_mm = 600.0;  ///< From the eye to the picture. Range 200..2000.
};

/// Of the program's settings, each brought into its range; by default the width that the screen tells.
MirrorSettings load_mirror_settings();
void save_mirror_settings(const MirrorSettings& settings);

/// Where a view stands in the window, pixels.
struct ViewPlace {
  double right_px = 0.0, down_px = 0.0;  ///< From the window's middle to the view's.
  int rows = 1;
  double mm_per_pixel = 0.25;  ///< In the mirror.
};
/// The camera (in W, although its fields say P) whose picture, shown there, has every point of the room on the line
/// from the eye to that point: a tool is seen where it is. The eye lies before the view's middle.
scene::CameraView mirror_camera_W(const MirrorSettings& settings, const ViewPlace& place) noexcept;
/// The same camera in P.
scene::CameraView moved(const Pose& X_PW, const scene::CameraView& view_W) noexcept;

}  // namespace trocar::trainer
