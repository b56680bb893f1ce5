#include "lab/haptics/closed_motion.h"

#include <algorithm>

namespace trocar::haptics {

void ClosedMotion::add(const Vec3& shift_P, const Vec3& turn_rad_P, double mm_per_s) {
  constexpr double kLeast_s = 0.01;
  const MotionKey& last = keys_.back();
  const double way_mm = (shift_P - last.shift_P).norm() + kReach_mm * (turn_rad_P - last.turn_rad_P).norm();
  MotionKey key;
  key.time_s = last.time_s + std::max(kLeast_s, way_mm / mm_per_s);
  key.shift_P = shift_P;
  key.turn_rad_P = turn_rad_P;
  keys_.push_back(key);
}

void ClosedMotion::go(const Vec3& shift_P, const Vec3& turn_rad_P, double mm_per_s) {
  add(shift_P, turn_rad_P, mm_per_s);
  for (std::size_t i = last_stop_ + 1; i + 1 < keys_.size(); ++i) {
    const MotionKey& before = keys_[i - 1];
    const MotionKey& after = keys_[i + 1];
    keys_[i].shift_rate_P = (after.shift_P - before.shift_P) / (after.time_s - before.time_s);
    keys_[i].turn_rate_P = (after.turn_rad_P - before.turn_rad_P) / (after.time_s - before.time_s);
  }
  last_stop_ = keys_.size() - 1;
}

void ClosedMotion::pass(const Vec3& shift_P, const Vec3& turn_rad_P, double mm_per_s) {
  add(shift_P, turn_rad_P, mm_per_s);
}

void ClosedMotion::wait(double seconds) {
  if (!(seconds > 0.0)) return;
  MotionKey key = keys_.back();
  key.time_s += seconds;
  keys_.push_back(key);
  last_stop_ = keys_.size() - 1;
}

Pose ClosedMotion::at(double time_s) const noexcept {
  const auto after = std::upper_bound(keys_.begin(), keys_.end(), time_s,
                                      [](double time, const MotionKey& key) { return time < key.time_s; });
  Vec3 shift_P = keys_.back().shift_P, turn_rad_P = keys_.back().turn_rad_P;
  if (after == keys_.begin()) return X_start_;
  if (after != keys_.end()) {
    const MotionKey& a = *(after - 1);
    const MotionKey& b = *after;
    const double h = b.time_s - a.time_s, t = (time_s - a.time_s) / h;
    const double to_b = t * t * (3.0 - 2.0 * t);
    const double rate_a = h * t * (1.0 - t) * (1.0 - t), rate_b = -h * t * t * (1.0 - t);
    shift_P = a.shift_P + to_b * (b.shift_P - a.shift_P) + rate_a * a.shift_rate_P + rate_b * b.shift_rate_P;
    turn_rad_P = a.turn_rad_P + to_b * (b.turn_rad_P - a.turn_rad_P) + rate_a * a.turn_rate_P + rate_b * b.turn_rate_P;
  }
  const Mat3 R_turn = rotation_from_vector(turn_rad_P);
  const Vec3 axis_P = X_start_.R().col(2);
  return {R_turn * X_start_.R(), X_start_.p() + shift_P + pivot_mm_ * (R_turn * axis_P - axis_P)};
}

}  // namespace trocar::haptics
