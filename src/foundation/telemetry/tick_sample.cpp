#include "telemetry/tick_sample.h"

namespace trocar::telemetry {

const char* to_string(InsertionPhase phase) noexcept {
  switch (phase) {
    case InsertionPhase::kOutside:
      return "outside";
    case InsertionPhase::kLoading:
      return "loading";
    case InsertionPhase::kInserted:
      return "inserted";
    case InsertionPhase::kRetracting:
      return "retracting";
  }
  return "outside";
}

const char* to_string(LimitReason reason) noexcept {
  switch (reason) {
    case LimitReason::kForceClamped:
      return "force";
    case LimitReason::kTorqueClamped:
      return "torque";
    case LimitReason::kInputRejected:
      return "input";
    case LimitReason::kSolverBound:
      return "solver";
    case LimitReason::kEventsDropped:
      return "events";
    case LimitReason::kResumedInside:
      return "resumed";
    case LimitReason::kJumped:
      return "jump";
    case LimitReason::kPassivity:
      return "passivity";
    case LimitReason::kContinuous:
      return "continuous";
    case LimitReason::kSlew:
      return "slew";
    case LimitReason::kStale:
      return "stale";
    case LimitReason::kBrake:
      return "brake";
    case LimitReason::kSafeStart:
      return "safe_start";
    case LimitReason::kFault:
      return "fault";
  }
  return "unknown";
}

double axial_resistance_n(const TickSample& s) noexcept {
  return -(s.f_prepuncture_n + s.f_friction_n + s.f_cutting_n + s.f_body_axial_n + s.f_tip_proxy_n.dot(s.axis));
}

double tip_load_n(const TickSample& s) noexcept {
  return -(s.f_prepuncture_n + s.f_tip_proxy_n.dot(s.axis));
}

}  // namespace trocar::telemetry
