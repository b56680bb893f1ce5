#pragma once

#include "attempt/tools/led_pose.h"
#include "link/messages.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

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
  LedPose hand_;
};

/// Room of a transducer in the patient: orientation of the needle's room; the origin is the grip of a transducer that
/// is held at X_PT.
Pose transducer_room(const Pose& X_PW_of_needle, const Pose& X_PT) noexcept;

}  // namespace trocar::attempt
