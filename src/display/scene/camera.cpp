#include "scene/camera.h"

#include <algorithm>
#include <cmath>

namespace trocar::scene {
namespace {

constexpr double kMargin = 1.05;
constexpr double kNearest_mm = 20.0;
constexpr double kFarthest_mm = 5000.0;
/// Minimum angle between the view direction and the head-feet axis during rotation by hand.
constexpr double kPoleGap_rad = 0.03;
constexpr double kSideDistance_mm = 320.0;
constexpr double kBeforeTip_mm = 30.0;
/// The camera is at the start of the shaft with a small offset, as the hub would otherwise hide everything.
constexpr double kBesideShaft_mm = 14.0;

/// Unit vectors from the patient to the camera and upward, in P (x left, y back, z head).
struct Direction {
  Vec3 back_P;
  Vec3 up_P;
};

Direction direction_of(CameraPreset preset) {
  switch (preset) {
    case CameraPreset::kAnterior:
      return {{0, -1, 0}, {0, 0, 1}};
    case CameraPreset::kRightAnteriorOblique:
      return {Vec3(-0.72, -0.80, 0.30).normalized(), {0, 0, 1}};
    case CameraPreset::kLeftAnteriorOblique:
      return {Vec3(0.72, -0.80, 0.30).normalized(), {0, 0, 1}};
    case CameraPreset::kRight:
      return {{-1, 0, 0}, {0, 0, 1}};
    case CameraPreset::kLeft:
      return {{1, 0, 0}, {0, 0, 1}};
    case CameraPreset::kPosterior:
      return {{0, 1, 0}, {0, 0, 1}};
    case CameraPreset::kCranial:
      return {{0, 0, 1}, {0, -1, 0}};
  }
  return {{0, -1, 0}, {0, 0, 1}};
}

/// The component of `v` perpendicular to the unit vector `axis`, normalised; an arbitrary perpendicular vector if it is
/// zero.
Vec3 square_to(const Vec3& v, const Vec3& axis) {
  const Vec3 part = v - v.dot(axis) * axis;
  return part.norm() > 1e-6 ? part.normalized() : axis.unitOrthogonal();
}

Vec3 rotated(const Vec3& v, const Vec3& axis, double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, axis) * v;
}

}  // namespace

double CameraView::mm_per_pixel(const Vec3& p_P, int rows) const noexcept {
  const double depth_mm = std::max(kNearest_mm, (p_P - eye_P).dot(forward_P()));
  return 2.0 * depth_mm * std::tan(0.5 * view_angle_rad) / std::max(1, rows);
}

CameraPreset preset_facing(const Vec3& outward_P) noexcept {
  constexpr CameraPreset kPresets[] = {CameraPreset::kRightAnteriorOblique, CameraPreset::kLeftAnteriorOblique,
                                       CameraPreset::kPosterior};
  return *std::max_element(std::begin(kPresets), std::end(kPresets), [&](CameraPreset a, CameraPreset b) {
    return direction_of(a).back_P.dot(outward_P) < direction_of(b).back_P.dot(outward_P);
  });
}

CameraView fit_camera(std::span<const Vec3> points_P, CameraPreset preset, double aspect) {
  const auto [back_P, hint_P] = direction_of(preset);
  const Vec3 up_P = square_to(hint_P, back_P);
  const Vec3 right_P = up_P.cross(back_P);
  const auto to_camera = [&](const Vec3& p_P) -> Vec3 { return {p_P.dot(right_P), p_P.dot(up_P), p_P.dot(back_P)}; };
  Vec3 low = to_camera(points_P.front());
  Vec3 high = low;
  for (const Vec3& p_P : points_P) {
    low = low.cwiseMin(to_camera(p_P));
    high = high.cwiseMax(to_camera(p_P));
  }
  const Vec3 middle = 0.5 * (low + high);
  CameraView view;
  double distance_mm = kNearest_mm;
  for (const Vec3& p_P : points_P) {
    const Vec3 p = to_camera(p_P) - middle;
    const double half_height = kMargin * std::max(std::abs(p.y()), std::abs(p.x()) / aspect);
    distance_mm = std::max(distance_mm, p.z() + half_height / std::tan(0.5 * view.view_angle_rad));
  }
  view.focus_P = middle.x() * right_P + middle.y() * up_P + middle.z() * back_P;
  view.eye_P = view.focus_P + distance_mm * back_P;
  view.up_P = up_P;
  return view;
}

CameraView orbited(const CameraView& view, double right_rad, double up_rad) noexcept {
  const Vec3 head_P = Vec3::UnitZ();
  CameraView turned = view;
  const Vec3 back_P = -view.forward_P();
  const double from_pole_rad = std::acos(std::clamp(back_P.dot(head_P), -1.0, 1.0));
  // Dragging upward raises the patient's front: the camera moves towards the feet.
  const double new_from_pole_rad =
      std::clamp(from_pole_rad + up_rad, kPoleGap_rad, std::numbers::pi - kPoleGap_rad) - from_pole_rad;
  const Vec3 right_P = view.right_P();
  Vec3 new_back_P = rotated(back_P, right_P, new_from_pole_rad);
  Vec3 new_right_P = right_P;
  new_back_P = rotated(new_back_P, head_P, -right_rad);
  new_right_P = rotated(new_right_P, head_P, -right_rad);
  turned.eye_P = view.focus_P + view.distance_mm() * new_back_P;
  turned.up_P = square_to(new_back_P.cross(new_right_P), new_back_P);
  return turned;
}

CameraView panned(const CameraView& view, double right, double down) noexcept {
  const double height_mm = 2.0 * view.distance_mm() * std::tan(0.5 * view.view_angle_rad);
  const Vec3 shift_P = height_mm * (down * view.up_P - right * view.right_P());
  CameraView moved = view;
  moved.eye_P += shift_P;
  moved.focus_P += shift_P;
  return moved;
}

CameraView zoomed(const CameraView& view, double factor) noexcept {
  CameraView nearer = view;
  const double distance_mm = std::clamp(view.distance_mm() / factor, kNearest_mm, kFarthest_mm);
  nearer.eye_P = view.focus_P - distance_mm * view.forward_P();
  return nearer;
}

CameraView following(const CameraView& view, FollowMode mode, const Segment& needle_P, bool is_new) noexcept {
  CameraView next = view;
  const Vec3 axis_P = needle_P.direction();
  const Vec3& tip_P = needle_P.b;
  switch (mode) {
    case FollowMode::kFree:
      return view;
    case FollowMode::kTip:
      next.eye_P += tip_P - view.focus_P;
      next.focus_P = tip_P;
      return next;
    case FollowMode::kAlongNeedle: {
      const Vec3 up_P = square_to(std::abs(axis_P.z()) < 0.95 ? Vec3(0, 0, 1) : Vec3(0, -1, 0), axis_P);
      next.eye_P = needle_P.a + kBesideShaft_mm * up_P;
      next.focus_P = tip_P + kBeforeTip_mm * axis_P;
      next.up_P = square_to(up_P, next.forward_P());
      return next;
    }
    case FollowMode::kSide: {
      // From the patient's feet, perpendicular to the shaft: the view then corresponds to an axial CT slice.
      const Vec3 back_P = square_to(std::abs(axis_P.z()) < 0.95 ? Vec3(0, 0, -1) : Vec3(-1, 0, 0), axis_P);
      const double distance_mm = is_new ? kSideDistance_mm : view.distance_mm();
      next.focus_P = tip_P;
      next.eye_P = tip_P + distance_mm * back_P;
      next.up_P = square_to(std::abs(back_P.y()) < 0.95 ? Vec3(0, -1, 0) : Vec3(0, 0, 1), back_P);
      return next;
    }
  }
  return next;
}

}  // namespace trocar::scene
