#pragma once

#include <numbers>
#include <span>

#include "geometry/shapes.h"

namespace trocar::scene {

/// A camera position around the patient. The head is up; in views from the head or from the feet, the front is up.
enum class CameraPreset {
  kAnterior,
  kRightAnteriorOblique,
  kLeftAnteriorOblique,
  kRight,
  kLeft,
  kPosterior,
  kCranial,  ///< From above the head.
};

/// Camera motion of a live view when the needle moves.
enum class FollowMode {
  kFree,         ///< No motion.
  kTip,          ///< Keeps the tip in the middle; direction and distance are constant.
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
  /// Size of a pixel at a point, in an image of `rows` rows.
  double mm_per_pixel(const Vec3& p_P, int rows) const noexcept;
};

/// The preset that looks best at skin with this outward direction: an oblique one for front and sides, or the back.
CameraPreset preset_facing(const Vec3& outward_P) noexcept;

/// Camera towards the middle of the points (at least one), at the smallest distance at which an image of `aspect`
/// (columns over rows) contains all points with a margin.
CameraView fit_camera(std::span<const Vec3> points_P, CameraPreset preset, double aspect);

/// Orbits about the focus: a mouse drag moves the patient to the right and up (rad). The view stops before the poles.
CameraView orbited(const CameraView& view, double right_rad, double up_rad) noexcept;
/// Pans the view: the point at the focus moves `right` and `down` in the image, as shares of the image height.
CameraView panned(const CameraView& view, double right, double down) noexcept;
/// Divides the distance to the focus by `factor` (above 1: nearer); limited to 20 mm .. 5 m.
CameraView zoomed(const CameraView& view, double factor) noexcept;
/// The view in a mode for a needle (hub to tip); kFree returns it unchanged. `is_new`: the mode was just selected and
/// also sets its distance.
CameraView following(const CameraView& view, FollowMode mode, const Segment& needle_P, bool is_new) noexcept;

}  // namespace trocar::scene
