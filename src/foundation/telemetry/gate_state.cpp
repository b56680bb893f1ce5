#include "telemetry/gate_state.h"

namespace trocar::telemetry {

const char* to_string(GateFault fault) noexcept {
  switch (fault) {
    case GateFault::kNone:
      return "none";
    case GateFault::kNotFinite:
      return "not_finite";
    case GateFault::kDeviceLost:
      return "device_lost";
    case GateFault::kDeviceSilent:
      return "device_silent";
    case GateFault::kRunaway:
      return "runaway";
    case GateFault::kEncoderStuck:
      return "encoder_stuck";
    case GateFault::kLoopStalled:
      return "loop_stalled";
    case GateFault::kRequested:
      return "requested";
    case GateFault::kLoopSlow:
      return "loop_slow";
    case GateFault::kImpossibleMotion:
      return "impossible_motion";
    case GateFault::kVibration:
      return "vibration";
  }
  return "unknown";
}

const char* to_string(GateMode mode) noexcept {
  switch (mode) {
    case GateMode::kOff:
      return "off";
    case GateMode::kWaiting:
      return "waiting";
    case GateMode::kRising:
      return "rising";
    case GateMode::kOn:
      return "on";
    case GateMode::kFading:
      return "fading";
    case GateMode::kFault:
      return "fault";
    case GateMode::kAbsent:
      return "absent";
  }
  return "unknown";
}

}  // namespace trocar::telemetry
