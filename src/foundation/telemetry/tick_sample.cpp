#include "telemetry/tick_sample.h"

#include <algorithm>
#include <cmath>

#include "geometry/pose.h"

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

namespace {

constexpr double kClear_mm = 0.1;  // in front of a layer, so that its place is not in it

Mat3 device_rotation(const TickSample& sample) noexcept {
  const Eigen::Quaterniond q = from_wxyz(sample.device_rotation_wxyz);
  return q.norm() > 0.0 ? q.normalized().toRotationMatrix() : Mat3(Mat3::Identity());
}

/// The device's rotation, with the minimal rotation that aligns its `column` with the axis of the virtual needle.
Mat3 felt_rotation(const TickSample& sample, int column) noexcept {
  const Mat3 R = device_rotation(sample);
  return sample.axis.norm() > 0.0 ? Mat3(rotation_between(R.col(column), sample.axis.normalized()) * R) : R;
}

}  // namespace

Pose device_pose(const TickSample& sample) noexcept {
  return {device_rotation(sample), sample.device_mm};
}

Pose felt_needle(const TickSample& sample) noexcept {
  return {felt_rotation(sample, 2), sample.tip_mm};
}

bool is_in_body(const TickSample& sample) noexcept {
  const bool is_on_skin =
      sample.phase == InsertionPhase::kLoading && sample.depth_mm <= sample.layer_displacement_mm + kClear_mm;
  return sample.depth_mm > 0.0 && !is_on_skin;
}

Vec3 pierced_rest_tip_mm(const TickSample& sample) noexcept {
  const bool is_loading = sample.phase == InsertionPhase::kLoading && sample.layer_displacement_mm > 0.0;
  return is_loading ? Vec3(sample.rest_tip_mm - (sample.layer_displacement_mm + kClear_mm) * sample.rest_axis)
                    : sample.rest_tip_mm;
}

NeedlePlace needle_place(const TickSample& sample) noexcept {
  constexpr double kOblique = 3.0;  // a needle at 70 degrees to the skin's normal
  const Pose felt = felt_needle(sample);
  const double deep_mm = sample.layer_displacement_mm;
  const bool is_loading = sample.phase == InsertionPhase::kLoading;
  if (is_loading && !is_in_body(sample))  // on unpierced skin
    return {felt * Pose::translation({0.0, 0.0, -kOblique * deep_mm - kClear_mm}), 0.0};
  if (sample.phase == InsertionPhase::kOutside) return {felt, 0.0};
  const double back_mm = is_loading ? deep_mm + kClear_mm : 0.0;
  const double ahead_mm = std::max(0.0, sample.axis.dot(sample.device_mm - sample.tip_mm));
  return {felt * Pose::translation({0.0, 0.0, -back_mm}), ahead_mm};
}

Pose felt_probe(const TickSample& sample) noexcept {
  return {felt_rotation(sample, 1), sample.tip_mm};
}

bool add_event(TickSample& sample, TickEvent event) noexcept {
  for (TickEvent& entry : sample.events) {
    if (entry.kind != EventKind::kNone) continue;
    entry = event;
    return true;
  }
  return false;
}

bool ToolPose::is_valid() const noexcept {
  constexpr double kRounding = 1e-6;
  return p_mm.allFinite() && std::abs(from_wxyz(rotation_wxyz).norm() - 1.0) < kRounding;
}

Pose ToolPose::pose() const noexcept {
  return {from_wxyz(rotation_wxyz).toRotationMatrix(), p_mm};
}

ToolPose to_tool_pose(const Pose& X_PTool) noexcept {
  return {to_wxyz(Eigen::Quaterniond(X_PTool.R()).normalized()), X_PTool.p()};
}

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
