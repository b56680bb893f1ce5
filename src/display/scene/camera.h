#pragma once

#include <numbers>
#include <span>

#include "geometry/segment.h"

namespace trocar::scene {

/// A camera position around the patient. The head is up; seen from the head or from the feet, the front is up.
enum class CameraPreset {
  kAnterior,
  kRightAnteriorOblique,
  kRight,
  kLeft,
  kPosterior,
  kCranial,  ///< From above the head.
};

/// What the camera of a live view does when the needle moves.
enum class FollowMode {
  kFree,         ///< Nothing.
  kTip,          ///< Keeps the tip in the middle, its direction and distance stay.
  kAlongNeedle,  ///< View from the hub along the shaft.
  kSide,         ///< View of the tip perpendicular to the shaft, at close range; structures in front of the needle are
                 ///< clipped.
};

/// Camera position and focal point in P (mm). Invariant of the functions below: `up_P` is a unit vector perpendicular
/// to the view direction.
struct CameraView {
  Vec3 eye_P{0, -1000, 0};
  Vec3 focus_P{0, 0, 0};
  Vec3 up_P{0, 0, 1};
  double view_angle_rad = 0.42;  ///< From the lower to the upper edge. Range 0.05..1.5.

  /// Unit vector from the eye to the focus.
  Vec3 forward_P() const noexcept { return (focus_P - eye_P).normalized(); }
  Vec3 right_P() const noexcept { return forward_P().cross(up_P).normalized(); }
  double distance_mm() const noexcept { return (focus_P - eye_P).norm(); }
  /// Size of a pixel at a point, in a picture of `rows` rows.
  double mm_per_pixel(const Vec3& p_P, int rows) const noexcept;
};

/// Looks at the middle of the points (at least one) as near as all of them stay in a picture of `aspect` (columns over
/// rows), with a margin.
CameraView fit_camera(std::span<const Vec3> points_P, CameraPreset preset, double aspect);

/// Turned about the focus: to the right and upward as a hand drags the patient (rad). Stops short of the poles.
CameraView orbited(const CameraView& view, double right_rad, double up_rad) noexcept;
/// Moved across, so that what lies at the focus goes `right` and `down` by shares of the picture's height.
CameraView panned(const CameraView& view, double right, double down) noexcept;
/// Nearer by a factor (above 1), or farther; between 20 mm and 5 m from the focus.
CameraView zoomed(const CameraView& view, double factor) noexcept;
/// The view in a mode for a needle (hub to tip); kFree gives it back as it is. `is_new`: the mode has just been chosen,
/// so that it also sets its distance.
CameraView following(const CameraView& view, FollowMode mode, const Segment& needle_P, bool is_new) noexcept;

}  // namespace trocar::scene
