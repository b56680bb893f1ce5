#include "attempt/tools/led_pose.h"

#include <algorithm>
#include <cmath>

#include "geometry/clamp_norm.h"

namespace trocar::attempt {
namespace {

Mat3 turned(const Mat3& R, const Vec3& turn_rad) noexcept {
  const double angle = turn_rad.norm();
  if (angle < 1e-12) return R;
  const Mat3 by = Eigen::AngleAxisd(angle, turn_rad / angle).toRotationMatrix();
  return Eigen::Quaterniond(by * R).normalized().toRotationMatrix();
}

}  // namespace

Vec3 turn_between(const Mat3& from, const Mat3& to) noexcept {
  const Eigen::AngleAxisd turn(Mat3(to * from.transpose()));
  return turn.angle() * turn.axis();
}

Pose moved(const Pose& X, const Vec3& shift, const Vec3& turn_rad) noexcept {
  return {turned(X.R(), turn_rad), X.p() + shift};
}

Pose moved_towards(const Pose& from, const Pose& to, double most_mm, double most_rad) noexcept {
  if (!from.is_finite() || !to.is_finite()) return from;
  return moved(from, clamped_norm(to.p() - from.p(), most_mm), clamped_norm(turn_between(from.R(), to.R()), most_rad));
}

void LedPose::put(const Pose& X_P) noexcept {
  if (!X_P.is_finite()) return;
  X_P_ = goal_P_ = X_P;
  v_P_ = w_P_ = goal_v_P_ = goal_w_P_ = Vec3::Zero();
  age_s_ = 0.0;
}

void LedPose::lead(const Pose& X_P, const Vec3& v_P, const Vec3& w_P) noexcept {
  if (is_clamped_ || !X_P.is_finite() || !v_P.allFinite() || !w_P.allFinite()) return;
  goal_P_ = X_P;
  goal_v_P_ = clamped_norm(v_P, limits_.most_mm_per_s);
  goal_w_P_ = clamped_norm(w_P, limits_.most_rad_per_s);
  age_s_ = 0.0;
}

void LedPose::step(double dt_s) noexcept {
  if (!(dt_s > 0.0)) return;
  age_s_ += dt_s;
  const double ahead_s = std::min(age_s_, kStandsStill_s);
  const Pose wanted = is_clamped_ ? X_P_ : moved(goal_P_, ahead_s * goal_v_P_, ahead_s * goal_w_P_);
  const double share = 1.0 - std::exp(-dt_s / kSmoothing_s);
  const double step_mm = std::min(share * (wanted.p() - X_P_.p()).norm(), limits_.most_mm_per_s * dt_s);
  const double step_rad = std::min(share * turn_between(X_P_.R(), wanted.R()).norm(), limits_.most_rad_per_s * dt_s);
  const Pose next = moved_towards(X_P_, wanted, step_mm, step_rad);
  v_P_ = (next.p() - X_P_.p()) / dt_s;
  w_P_ = turn_between(X_P_.R(), next.R()) / dt_s;
  X_P_ = next;
}

}  // namespace trocar::attempt
