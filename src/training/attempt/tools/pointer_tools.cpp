#include "attempt/tools/pointer_tools.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "attempt/tools/tool_motion.h"
#include "geometry/vec.h"

namespace trocar::attempt {
namespace {

constexpr double kLongestStep_mm = 20.0;  ///< Limit of one gesture: longer ones are pointer errors.

Vec3 bounded(const Vec3& shift_P) {
  return shift_P.allFinite() ? clamped_norm(shift_P, kLongestStep_mm) : Vec3(Vec3::Zero());
}

/// Moves a point along the skin, then projects it onto the skin. The shift is brought onto the skin's plane along the
/// view, so that the point follows a pointer; along the normal where the view grazes the skin.
Vec3 moved_on_skin(const anatomy::SkinNow& skin, const Vec3& skin_P, const Vec3& shift_P, const Vec3& seen_along_P) {
  constexpr double kGrazing = 0.3;  // cosine between view and normal
  const Vec3 inward_P = skin.inward(skin_P);
  const bool is_seen = std::abs(inward_P.dot(seen_along_P)) > kGrazing;
  const Vec3& along_P = is_seen ? seen_along_P : inward_P;
  return skin.nearest(skin_P + shift_P - inward_P.dot(shift_P) / inward_P.dot(along_P) * along_P);
}

/// The direction, turned towards the skin's normal if it is flatter than allowed.
Vec3 steep_enough(const Vec3& axis_P, const Vec3& inward_P, double flattest_rad) {
  const double angle = angle_between_rad(axis_P, inward_P);
  if (angle <= flattest_rad) return axis_P;
  const Vec3 hinge = inward_P.cross(axis_P);
  if (hinge.norm() < 1e-9) return inward_P;
  return Eigen::AngleAxisd(flattest_rad, hinge.normalized()) * inward_P;
}

/// A handle at the far end tilts to the right and down: the corresponding rotation of the tool.
Vec3 leaned(const Vec3& axis_P, const Vec3& right_P, const Vec3& down_P, double right_rad, double down_rad) {
  const Vec3 handle_P = -axis_P + std::tan(std::clamp(right_rad, -0.5, 0.5)) * right_P +
                        std::tan(std::clamp(down_rad, -0.5, 0.5)) * down_P;
  return -handle_P.normalized();
}

/// Moves a point along the skin towards another one by at most `most_mm`. The other one itself if it is as near as
/// that, or if the way along the skin comes no nearer.
Vec3 stepped_on_skin(const anatomy::SkinNow& skin, const Vec3& from_P, const Vec3& to_P, double most_mm) {
  const Vec3 left_P = to_P - from_P;
  if (!(left_P.norm() > most_mm)) return to_P;
  const Vec3 inward_P = skin.inward(from_P);
  const Vec3 along_P = left_P - inward_P.dot(left_P) * inward_P;
  if (along_P.norm() < 1e-6) return to_P;
  const Vec3 next_P = skin.nearest(from_P + most_mm * along_P.normalized());
  constexpr double kLeastGain = 0.1;  // of the step
  return (to_P - next_P).norm() < left_P.norm() - kLeastGain * most_mm ? next_P : to_P;
}

/// Share of what is left to turn in this step, so that place and direction arrive together. Range 0..1.
double turn_share(double left_mm, double left_rad, double most_mm, double most_rad) {
  if (left_rad < 1e-9) return 1.0;
  const double with_place = left_mm > most_mm ? most_mm / left_mm : 1.0;
  return std::min(with_place, most_rad / left_rad);
}

}  // namespace

PointerNeedle::PointerNeedle(const anatomy::VirtualPatient& patient, const Segment& path_A, double length_mm)
    : patient_(&patient), skin_(patient), length_mm_(length_mm), entry_P_(path_A.a), axis_P_(path_A.direction()) {
  aim_at(path_A);
}

void PointerNeedle::set_motion(const motion::PatientMotion& motion) {
  if (motion.is_same_place(skin_.motion())) return;
  const Vec3 entry_A = skin_.motion().to_rest(entry_P_);
  skin_ = anatomy::SkinNow(*patient_, motion);
  entry_P_ = motion.to_now(entry_A);
  update();
}

void PointerNeedle::aim_at(const Segment& path_A) {
  const Segment path_P = skin_.path_now(path_A);
  entry_P_ = path_P.a;
  axis_P_ = path_P.direction();
  past_mm_ = -kAbove_mm;
  update();
}

bool PointerNeedle::approach(const Segment& path_A, double most_mm, double most_rad) {
  if (is_past_skin()) return true;
  const Segment path_P = skin_.path_now(path_A);
  const Vec3 goal_axis_P = path_P.direction();
  const double left_rad = angle_between_rad(axis_P_, goal_axis_P);
  const double left_mm = (path_P.a - entry_P_).norm();
  const double share = turn_share(left_mm, left_rad, most_mm, most_rad);
  past_mm_ = std::min(past_mm_, -kAbove_mm);
  entry_P_ = stepped_on_skin(skin_, entry_P_, path_P.a, most_mm);
  const Vec3 turn = turn_between(Mat3::Identity(), rotation_between(axis_P_, goal_axis_P));
  axis_P_ = (moved(Pose(), Vec3::Zero(), share * turn).R() * axis_P_).normalized();
  const bool is_there = entry_P_ == path_P.a && share >= 1.0;
  if (is_there) aim_at(path_A);
  if (!is_there) update();
  return is_there;
}

void PointerNeedle::put(const Pose& X_PN) {
  if (!X_PN.is_finite()) return;
  axis_P_ = X_PN.R().col(2).normalized();
  // Back along the axis to the skin.
  double back_mm = 0.0;
  constexpr int kSteps = 12;
  for (int step = 0; step < kSteps; ++step) {
    const Vec3 at_P = X_PN.p() - back_mm * axis_P_;
    const double distance_mm = skin_.distance_mm(at_P);
    const double steepness = std::max(0.2, axis_P_.dot(skin_.inward(at_P)));
    back_mm -= distance_mm / steepness;
    back_mm = std::clamp(back_mm, -kFarthest_mm, length_mm_);
  }
  entry_P_ = X_PN.p() - back_mm * axis_P_;
  past_mm_ = back_mm;
  const Mat3 R_unrolled = needle_pose(Vec3::Zero(), axis_P_).R();
  const Mat3 R_roll = R_unrolled.transpose() * X_PN.R();
  roll_rad_ = std::atan2(R_roll(1, 0), R_roll(0, 0));
  update();
}

void PointerNeedle::glide(const Vec3& shift_P, const Vec3& seen_along_P) {
  const Vec3 shift = bounded(shift_P);
  if (!is_past_skin()) {
    entry_P_ = moved_on_skin(skin_, entry_P_, shift, seen_along_P);
    return lean(axis_P_);
  }
  const double outside_mm = std::max(10.0, length_mm_ - past_mm_);
  lean((axis_P_ * outside_mm - (shift - axis_P_.dot(shift) * axis_P_)).normalized());
}

void PointerNeedle::tilt(const Vec3& right_P, const Vec3& down_P, double right_rad, double down_rad) {
  if (std::isfinite(right_rad) && std::isfinite(down_rad)) lean(leaned(axis_P_, right_P, down_P, right_rad, down_rad));
}

void PointerNeedle::turn(double rad) {
  if (std::isfinite(rad)) roll_rad_ = std::remainder(roll_rad_ + rad, 2.0 * M_PI);
  update();
}

bool PointerNeedle::turn_bevel(const Vec3& bevel_P, double most_rad) {
  const Vec3 face_P = X_PN_.R().col(1);
  const Vec3 goal_P = bevel_P - bevel_P.dot(axis_P_) * axis_P_;
  if (!(goal_P.norm() > 1e-6)) return true;
  const double left_rad = std::atan2(face_P.cross(goal_P).dot(axis_P_), face_P.dot(goal_P));
  turn(std::clamp(left_rad, -most_rad, most_rad));
  return std::abs(left_rad) <= most_rad;
}

void PointerNeedle::push(double mm) {
  if (std::isfinite(mm)) past_mm_ = std::clamp(past_mm_ + mm, -kFarthest_mm, length_mm_ - 5.0);
  update();
}

void PointerNeedle::lean(const Vec3& axis_P) {
  axis_P_ = steep_enough(axis_P, skin_.inward(entry_P_), kFlattest_rad).normalized();
  update();
}

void PointerNeedle::update() {
  const Pose X_unrolled = needle_pose(entry_P_ + past_mm_ * axis_P_, axis_P_);
  X_PN_ = {X_unrolled.R() * Eigen::AngleAxisd(roll_rad_, Vec3::UnitZ()).toRotationMatrix(), X_unrolled.p()};
}

PointerProbe::PointerProbe(const anatomy::VirtualPatient& patient, const Pose& X_PT)
    : patient_(&patient), skin_(patient) {
  put(X_PT);
}

void PointerProbe::set_motion(const motion::PatientMotion& motion) {
  if (motion.is_same_place(skin_.motion())) return;
  const Vec3 skin_A = skin_.motion().to_rest(skin_P_), before_P = skin_.inward(skin_P_);
  skin_ = anatomy::SkinNow(*patient_, motion);
  skin_P_ = motion.to_now(skin_A);
  R_PT_ = rotation_between(before_P, skin_.inward(skin_P_)) * R_PT_;
}

void PointerProbe::put(const Pose& X_PT) {
  if (!X_PT.is_finite()) return;
  R_PT_ = X_PT.R();
  skin_P_ = skin_.nearest(X_PT.p());
  pressed_mm_ = std::clamp((X_PT.p() - skin_P_).dot(R_PT_.col(1)), -kFarthest_mm, kDeepest_mm);
}

bool PointerProbe::approach(const Pose& X_PT, double most_mm, double most_rad) {
  PointerProbe goal = *this;
  goal.put(X_PT);
  const double left_mm = (goal.skin_P_ - skin_P_).norm();
  const Vec3 before_P = skin_.inward(skin_P_);
  skin_P_ = stepped_on_skin(skin_, skin_P_, goal.skin_P_, most_mm);
  R_PT_ = rotation_between(before_P, skin_.inward(skin_P_)) * R_PT_;
  const Vec3 turn_P = turn_between(R_PT_, goal.R_PT_);
  const double share = turn_share(left_mm, turn_P.norm(), most_mm, most_rad);
  R_PT_ = moved(Pose(R_PT_, Vec3::Zero()), Vec3::Zero(), share * turn_P).R();
  pressed_mm_ += std::clamp(goal.pressed_mm_ - pressed_mm_, -most_mm, most_mm);
  const bool is_there = skin_P_ == goal.skin_P_ && share >= 1.0 && pressed_mm_ == goal.pressed_mm_;
  if (is_there) *this = goal;
  return is_there;
}

Pose PointerProbe::X_PT() const noexcept {
  return {R_PT_, skin_P_ + pressed_mm_ * R_PT_.col(1)};
}

void PointerProbe::glide(const Vec3& shift_P, const Vec3& seen_along_P) {
  const Vec3 before_P = skin_.inward(skin_P_);
  skin_P_ = moved_on_skin(skin_, skin_P_, bounded(shift_P), seen_along_P);
  R_PT_ = rotation_between(before_P, skin_.inward(skin_P_)) * R_PT_;
}

void PointerProbe::tilt(const Vec3& right_P, const Vec3& down_P, double right_rad, double down_rad) {
  if (!std::isfinite(right_rad) || !std::isfinite(down_rad)) return;
  const Vec3 beam_P = R_PT_.col(1);
  const Vec3 leaned_P =
      steep_enough(leaned(beam_P, right_P, down_P, right_rad, down_rad), skin_.inward(skin_P_), kFlattest_rad);
  R_PT_ = rotation_between(beam_P, leaned_P.normalized()) * R_PT_;
}

void PointerProbe::turn(double rad) {
  if (std::isfinite(rad)) R_PT_ = R_PT_ * Eigen::AngleAxisd(rad, Vec3::UnitY()).toRotationMatrix();
}

void PointerProbe::push(double mm) {
  if (std::isfinite(mm)) pressed_mm_ = std::clamp(pressed_mm_ + mm, -kFarthest_mm, kDeepest_mm);
}

}  // namespace trocar::attempt
