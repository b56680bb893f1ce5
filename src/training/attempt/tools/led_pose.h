#pragma once

#include "geometry/pose.h"

namespace trocar::attempt {

/// Speed limits of a hand that moves a tool. [assumed]
struct SpeedLimits {
  double most_mm_per_s = 60.0;  ///< Speed of the tool's origin. Range 1..1000.
  double most_rad_per_s = 1.5;  ///< Range 0.1..20.
};

/// Pose between `from` and `to`: the origin moved by at most `most_mm`, the rotation turned by at most `most_rad` the
/// shortest way. Poses that are not finite cause no motion.
Pose moved_towards(const Pose& from, const Pose& to, double most_mm, double most_rad) noexcept;

/// Axis times angle (rad) from one rotation to another, in the frame they are given in.
Vec3 turn_between(const Mat3& from, const Mat3& to) noexcept;
/// A pose turned by a rotation vector about its own origin, and moved.
Pose moved(const Pose& X, const Vec3& shift, const Vec3& turn_rad) noexcept;

/// A hand whose target is set by a window once per frame, and which moves smoothly: first-order lag of kSmoothing_s,
/// with limits. Between targets it extrapolates with the last velocity for at most kStandsStill_s. Bounded; no clock.
class LedPose {
 public:
  static constexpr double kStandsStill_s = 0.05;
  static constexpr double kSmoothing_s = 0.03;  ///< Two frames of a window. [assumed]

  explicit LedPose(const SpeedLimits& limits = {}) noexcept : limits_(limits) {}

  void put(const Pose& X_P) noexcept;                                     ///< Takes effect at once, at rest.
  void lead(const Pose& X_P, const Vec3& v_P, const Vec3& w_P) noexcept;  ///< Ignored if not finite.
  void clamp(bool is_clamped) noexcept { is_clamped_ = is_clamped; }
  void step(double dt_s) noexcept;

  const Pose& X_P() const noexcept { return X_P_; }
  const Vec3& v_P() const noexcept { return v_P_; }  ///< mm/s
  const Vec3& w_P() const noexcept { return w_P_; }  ///< rad/s
  const Pose& goal_P() const noexcept { return goal_P_; }
  bool is_clamped() const noexcept { return is_clamped_; }

 private:
  SpeedLimits limits_;
  Pose X_P_, goal_P_;
  Vec3 v_P_ = Vec3::Zero(), w_P_ = Vec3::Zero();
  Vec3 goal_v_P_ = Vec3::Zero(), goal_w_P_ = Vec3::Zero();
  double age_s_ = 0.0;
  bool is_clamped_ = false;
};

}  // namespace trocar::attempt
