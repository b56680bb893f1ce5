#pragma once

#include "anatomy/patient.h"
#include "attempt/tools/transducer_motion.h"
#include "geometry/segment.h"

namespace trocar::attempt {

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
