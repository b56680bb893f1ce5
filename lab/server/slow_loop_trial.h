#pragma once

#include "devices/simulated/faulty_device.h"
#include "server/servo.h"

namespace trocar::server {

/// A trial with a simulated device: its reads or writes become slow while a hand moves it up and down in tissue. The
/// trial measures how soon the server removes the force (docs/validation.md, Slow loops). Simulated time.
struct SlowLoopTrial {
  devices::DeviceFault fault = devices::DeviceFault::kSlowRead;  ///< kSlowRead or kSlowWrite.
  double slow_ms = 0.0;                                          ///< Duration of each read or write; 0: no fault.
  double fault_s = 4.0;  ///< Start of the fault; the forces are on and the hand moves.
  double end_s = 8.0;
  double depth_mm = 15.0;  ///< Mean target depth of the tip; the skin is at z = 0 of P.
  double swing_mm = 10.0;
  double swing_hz = 0.5;
};

struct SlowLoopOutcome {
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  double longest_period_s = 0.0;
  double latch_s = 0.0;      ///< Time from the beginning of the first slow period to the fault; 0: none.
  int latch_periods = 0;     ///< Number of slow periods up to and including the one that latched.
  double zero_s = 0.0;       ///< Likewise, time to permanently zero force; infinite: never.
  double least_share = 1.0;  ///< Smallest share of the coupling.
  double before_n = 0.0;     ///< Largest force written before the fault.
  double after_n = 0.0;      ///< Largest force written after the start of the fault.
  double travel_mm = 0.0;    ///< Peak-to-peak travel of the stylus origin after the fault began, worst axis.
};

/// `preset`: without motors, the trial uses the pointer of a trainer instead of a simulated stylus. `scene`: the skin
/// is at z = 0, +z points into the body.
SlowLoopOutcome run_slow_loop_trial(const ServoScene& scene, const stylus::DevicePreset& preset,
                                    const SlowLoopTrial& trial);

}  // namespace trocar::server
