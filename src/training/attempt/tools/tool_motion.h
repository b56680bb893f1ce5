#pragma once

#include "anatomy/patient.h"
#include "geometry/pose.h"
#include "geometry/shapes.h"
#include "link/messages.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

/// Speed limits of a hand that moves a tool. [assumed]
struct SpeedLimits {
  double most_mm_per_s = 60.0;  ///< Speed of the tool's origin. Range 1..1000.
  double most_rad_per_s = 1.5;  ///< Range 0.1..20.
};
/// Of a needle away from the skin, and of a transducer: slower than people reach for something. [assumed]
inline constexpr SpeedLimits kFreeHand{150.0, 3.8};

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
  void limit(const SpeedLimits& limits) noexcept { limits_ = limits; }
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

/// Operator of an attempt's transducer. Plug point: a trainee (LedTransducer), or a hand that rests on the skin beside
/// the entry (RestingTransducer). Frame P.
class TransducerMotion {
 public:
  virtual ~TransducerMotion() = default;
  /// Pose at which the transducer is placed before the forces are switched on.
  virtual Pose X_PT_start() const = 0;
  /// Centre of the device's workspace, see transducer_room().
  virtual Pose X_PT_room() const = 0;
  /// The next target. `time_s`: since the forces were switched on; `dt_s`: since the last call. The target's
  /// server_time_s is not set.
  virtual link::HandTarget next(double time_s, double dt_s) = 0;
  /// Pose at which the transducer is placed when its server returns.
  virtual Pose X_PT_to_resume(const telemetry::TickSample& last) const = 0;
};

/// A transducer that a window leads: it begins above the skin and moves to its start pose.
class LedTransducer final : public TransducerMotion {
 public:
  static constexpr double kAboveSkin_mm = 10.0;

  explicit LedTransducer(const Pose& X_PT = {});
  LedPose& hand() noexcept { return hand_; }
  const LedPose& hand() const noexcept { return hand_; }

  Pose X_PT_start() const override { return X_PT_start_; }
  Pose X_PT_room() const override { return X_PT_; }
  link::HandTarget next(double time_s, double dt_s) override;
  Pose X_PT_to_resume(const telemetry::TickSample& last) const override;

 private:
  Pose X_PT_, X_PT_start_;
  LedPose hand_{kFreeHand};
};

/// Room of a transducer in the patient: orientation of the needle's room; the origin is the grip of a transducer that
/// is held at X_PT.
Pose transducer_room(const Pose& X_PW_of_needle, const Pose& X_PT) noexcept;

/// Simulated hand with the transducer on the skin near a needle's entry: presses down a few mm and stays, with tremor.
/// A function of time only. Frame P.
class RestingTransducer final : public TransducerMotion {
 public:
  /// Beside path_P.a, towards head or feet, where the skin is flatter.
  RestingTransducer(const anatomy::VirtualPatient& patient, const Segment& path_P) noexcept;

  /// Target pose of the transducer `time_s` after the forces were switched on; without server_time_s.
  link::HandTarget at(double time_s) const noexcept;

  Pose X_PT_start() const override { return at(0.0).X_PN; }
  Pose X_PT_room() const override { return X_PT_skin_; }
  link::HandTarget next(double time_s, double) override { return at(time_s); }
  /// The transducer is lowered again from its start pose.
  Pose X_PT_to_resume(const telemetry::TickSample&) const override { return X_PT_start(); }

  /// Distance from the entry along the skin's tangent, which leaves space for the needle.
  static constexpr double kBeside_mm = 40.0;
  static constexpr double kPress_mm = 4.0;   ///< Depth beyond the resting skin: 2.4 N at the hand's 0.6 N/mm. [assumed]
  static constexpr double kAbove_mm = 10.0;  ///< Height of the start pose above the skin.

 private:
  Pose X_PT_skin_;  ///< Pose on the resting skin.
};

}  // namespace trocar::attempt
