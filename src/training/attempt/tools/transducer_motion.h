#pragma once

#include "attempt/tools/led_pose.h"
#include "link/messages.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

/// Who moves the transducer of an attempt. Plug point: a trainee (LedTransducer), or a hand that rests on the skin
/// beside the entry (RestingTransducer). Frame P.
class TransducerMotion {
 public:
  virtual ~TransducerMotion() = default;
  /// Where the transducer is put before the forces are switched on.
  virtual Pose X_PT_start() const = 0;
  /// Centre of the device's workspace, see transducer_room().
  virtual Pose X_PT_room() const = 0;
  /// The next target. `time_s`: since the forces came on, `dt_s`: since the last call; its server_time_s is not set.
  virtual link::HandTarget next(double time_s, double dt_s) = 0;
  /// Where it is put when its server returns.
  virtual Pose X_PT_to_resume(const telemetry::TickSample& last) const = 0;
};

/// A transducer that a window leads: it begins above the skin and goes to its start pose.
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

/// Room of a transducer in the patient: turned as the needle's, with the grip at its origin where it is held at X_PT.
Pose transducer_room(const Pose& X_PW_of_needle, const Pose& X_PT) noexcept;

}  // namespace trocar::attempt
