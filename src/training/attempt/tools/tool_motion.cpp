#include "attempt/tools/tool_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/vec.h"
#include "haptics/contact/contact_face.h"
#include "telemetry/tick_sample.h"
#include "volume/sampling.h"

namespace trocar::attempt {

LedTransducer::LedTransducer(const Pose& X_PT)
    : X_PT_(X_PT), X_PT_start_(X_PT * Pose::translation({0.0, -kAboveSkin_mm, 0.0})) {
  hand_.put(X_PT_start_);
  hand_.lead(X_PT, Vec3::Zero(), Vec3::Zero());
}

link::HandTarget LedTransducer::next(double, double dt_s) {
  hand_.step(dt_s);
  link::HandTarget target;
  target.X_PN = hand_.X_P();
  target.v_P = hand_.v_P();
  target.w_P = hand_.w_P();
  return target;
}

Pose LedTransducer::X_PT_to_resume(const telemetry::TickSample& last) const {
  return telemetry::device_pose(last);
}

Pose transducer_room(const Pose& X_PW_of_needle, const Pose& X_PT) noexcept {
  const Pose X_TS = haptics::tool_in_stylus(haptics::make_face(haptics::Tool::kTransducer)).inverse();
  return {X_PW_of_needle.R(), (X_PT * X_TS).p()};
}

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

namespace {

constexpr double kPressing_mm_s = 10.0;           // [assumed]
constexpr double kTremor_mm = 0.1;                // amplitude [assumed]
constexpr std::array kTremor_hz{8.0, 9.7, 11.9};  // physiological: 8 to 12 Hz

constexpr double kNearlyAlongBody = 0.99;  // skin that faces head or feet has no direction along the body

struct SkinPoint {
  Vec3 p_P;
  Vec3 outwards_P;  ///< Unit.
};

SkinPoint find_skin(const volume::FloatGrid& distance_mm, Vec3 p_P) noexcept {
  constexpr int kSteps = 20;  // the distance is nearly exact: a few steps suffice
  Vec3 outwards_P = -Vec3::UnitY();
  for (int i = 0; i < kSteps; ++i) {
    const Vec3 slope = volume::gradient_per_mm(distance_mm, p_P);
    if (slope.norm() > 0.0) outwards_P = slope.normalized();
    p_P -= volume::sample_linear(distance_mm, p_P) * outwards_P;
  }
  return {p_P, outwards_P};
}

}  // namespace

RestingTransducer::RestingTransducer(const anatomy::VirtualPatient& patient, const Segment& path_P) noexcept {
  const volume::FloatGrid& distance_mm = patient.skin_distance_mm;
  const SkinPoint entry = find_skin(distance_mm, path_P.a);
  const bool is_on_top = std::abs(entry.outwards_P.z()) > kNearlyAlongBody;
  const Vec3 across = entry.outwards_P.cross(is_on_top ? Vec3::UnitX() : Vec3::UnitZ());
  const Vec3 along_body_P = across.cross(entry.outwards_P).normalized();
  const SkinPoint head = find_skin(distance_mm, entry.p_P + kBeside_mm * along_body_P);
  const SkinPoint feet = find_skin(distance_mm, entry.p_P - kBeside_mm * along_body_P);
  const bool is_head = head.outwards_P.dot(entry.outwards_P) >= feet.outwards_P.dot(entry.outwards_P);
  const SkinPoint& place = is_head ? head : feet;

  Mat3 R_PT;
  R_PT.col(1) = -place.outwards_P;
  // Lateral direction: across the body.
  R_PT.col(0) = (across - across.dot(R_PT.col(1)) * R_PT.col(1)).normalized();
  R_PT.col(2) = R_PT.col(0).cross(R_PT.col(1));
  X_PT_skin_ = Pose(R_PT, place.p_P);
}

link::HandTarget RestingTransducer::at(double time_s) const noexcept {
  const double lowered_mm = std::min(std::max(0.0, time_s) * kPressing_mm_s, kAbove_mm + kPress_mm);
  const bool is_moving = time_s > 0.0 && lowered_mm < kAbove_mm + kPress_mm;
  Vec3 tremor_T, tremor_mm_s_T;
  for (std::size_t i = 0; i < kTremor_hz.size(); ++i) {
    const double rad_s = 2.0 * std::numbers::pi * kTremor_hz[i];
    tremor_T[static_cast<Eigen::Index>(i)] = kTremor_mm * std::sin(rad_s * time_s);
    tremor_mm_s_T[static_cast<Eigen::Index>(i)] = kTremor_mm * rad_s * std::cos(rad_s * time_s);
  }
  link::HandTarget hand;
  const Vec3 offset_T = (lowered_mm - kAbove_mm) * Vec3::UnitY() + tremor_T;
  hand.X_PN = X_PT_skin_ * Pose::translation(offset_T);
  hand.v_P = X_PT_skin_.R() * (tremor_mm_s_T + (is_moving ? kPressing_mm_s : 0.0) * Vec3::UnitY());
  return hand;
}

}  // namespace trocar::attempt
