#pragma once

#include "devices/simulated/fault_schedule.h"
#include "server/servo.h"

namespace trocar::server {

/// A simulated device whose reads or writes become slow while a hand moves it up and down in tissue: how soon the
/// server takes the force away (docs/validation.md, Slow loops). Simulated time.
struct SlowLoopTrial {
  devices::DeviceFault fault = devices::DeviceFault::kSlowRead;  ///< kSlowRead or kSlowWrite.
  double slow_ms = 0.0;                                          ///< Of each read or write; 0: a healthy loop.
  double fault_s = 4.0;                                          ///< When it begins: forces are on, the hand moves.
  double end_s = 8.0;
  double depth_mm = 15.0;  ///< Of the tip that the hand wants, its mean; the skin lies at z = 0 of P.
  double swing_mm = 10.0;
  double swing_hz = 0.5;
};

struct SlowLoopOutcome {
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  double longest_period_s = 0.0;
  double latch_s = 0.0;      ///< From the beginning of the first slow period; 0: none.
  int latch_periods = 0;     ///< Slow periods up to the one that latched, that one counted.
  double zero_s = 0.0;       ///< Likewise, to zero force for good; infinite: never.
  double least_share = 1.0;  ///< Of the coupling.
  double before_n = 0.0;     ///< Largest force written before the fault, and
  double after_n = 0.0;      ///< after it began.
  double travel_mm = 0.0;    ///< Peak to peak of the stylus' origin after the fault began, the worst axis.
};

/// `preset` without motors: the pointer of a trainer instead of a simulated stylus. `scene`: the skin is at z = 0, +z
/// goes into the body.
SlowLoopOutcome run_slow_loop_trial(const ServoScene& scene, const haptics::DevicePreset& preset,
                                    const SlowLoopTrial& trial);

}  // namespace trocar::server
