#include "scene/detail/hand_layer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/detail/tool_layer.h"
#include "scene/needle_shape.h"

namespace trocar::scene::detail {
namespace {

constexpr double kFingerRadius_mm = 7.0;
constexpr double kFingerLength_mm = 45.0;
constexpr double kLean = 1.2;  ///< Of the finger's axis, against the skin's normal.
constexpr double kAround_mm = 11.0, kFingerRing_mm = 1.3;
constexpr double kMarkRadius_mm = 3.0;
constexpr double kSamePlace_mm = 0.05;
constexpr volume::Rgb kFingerColor = {0xd9, 0xb3, 0x9a};
constexpr volume::Rgb kMarkColor = {0x9a, 0x4d, 0xff};  ///< Of a surgical skin marker.

bool are_same_touch(const std::optional<Fingertip>& a, const std::optional<Fingertip>& b) {
  if (!a || !b) return !a && !b;
  return (a->p_P - b->p_P).norm() < kSamePlace_mm && (a->inward_P - b->inward_P).norm() < 1e-3 && a->color == b->color;
}

/// Circle on the skin about the fingertip.
std::vector<Vec3> ring_about(const Fingertip& finger) {
  constexpr int kPoints = 40;
  constexpr double kAbove_mm = 1.0;
  const Vec3 u_P = finger.inward_P.unitOrthogonal(), v_P = finger.inward_P.cross(u_P);
  std::vector<Vec3> ring_P;
  for (int n = 0; n <= kPoints; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / kPoints;
    ring_P.push_back(finger.p_P - kAbove_mm * finger.inward_P +
                     kAround_mm * (std::cos(angle) * u_P + std::sin(angle) * v_P));
  }
  return ring_P;
}

}  // namespace

HandLayer::HandLayer(vtkRenderer& renderer) : finger_actor_(make_tool(renderer)), marks_actor_(make_tool(renderer)) {}

bool HandLayer::set(const std::optional<Fingertip>& finger, std::span<const Vec3> skin_marks_P) {
  const bool has_moved = set_finger(finger);
  return set_marks(skin_marks_P) || has_moved;
}

bool HandLayer::set_finger(const std::optional<Fingertip>& finger) {
  if (are_same_touch(finger, finger_)) return false;
  finger_ = finger;
  finger_actor_->SetVisibility(finger.has_value());
  if (!finger) return true;
  // Leaning towards the feet, so that it does not cover the place that it feels.
  const Vec3 outward_P = -finger->inward_P;
  const Vec3 feet_P = -Vec3::UnitZ() + outward_P.z() * outward_P;
  const Vec3 axis_P = (outward_P + kLean * feet_P).normalized();
  const Vec3 end_P = finger->p_P + kFingerRadius_mm * outward_P;
  const Vec3 line_P[2] = {end_P, end_P + kFingerLength_mm * axis_P};
  const ShapePart parts[3] = {{make_tube(line_P, kFingerRadius_mm), kFingerColor, 0.1},
                              {make_ball(end_P, kFingerRadius_mm), kFingerColor, 0.1},
                              {make_tube(ring_about(*finger), kFingerRing_mm), finger->color, 0.1}};
  set_data(*finger_actor_, to_colored_polydata(parts));
  return true;
}

bool HandLayer::set_marks(std::span<const Vec3> marks_P) {
  if (std::equal(marks_P.begin(), marks_P.end(), marks_P_.begin(), marks_P_.end())) return false;
  marks_P_.assign(marks_P.begin(), marks_P.end());
  marks_actor_->SetVisibility(!marks_P_.empty());
  std::vector<ShapePart> parts;
  for (const Vec3& mark_P : marks_P_) parts.push_back({make_ball(mark_P, kMarkRadius_mm), kMarkColor, 0.1});
  if (!parts.empty()) set_data(*marks_actor_, to_colored_polydata(parts));
  return true;
}

}  // namespace trocar::scene::detail
