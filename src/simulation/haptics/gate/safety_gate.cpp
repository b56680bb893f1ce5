#include "haptics/gate/safety_gate.h"

#include <algorithm>
#include <cmath>

#include "haptics/gate/gate_stages.h"

namespace trocar::haptics {
namespace {

constexpr double kNominalPeriod_s = 0.001;  // for an invalid period of the caller
constexpr double kLongestPeriod_s = 0.1;    // longer gaps count as this [assumed]
constexpr double kLongestRise_s = 0.005;    // period for rises of the force: a gap does not permit a jump [assumed]
constexpr double kRampEnd = 1e-9;           // share of a ramp that is rounding
constexpr double kSum_s = 1e-9;             // rounding of a sum of periods
constexpr double kFall_n_per_s = 20.0;      // slower changes are hand motion, not drops [assumed, 5..100]
constexpr double kLeastDrop_n = 0.2;        // minimum reported drop [assumed, 0.1..1]

/// Period used by the gate.
struct Period {
  double dt_s;    ///< For decreases and for warming.
  double rise_s;  ///< For increases of the force.
};

Period make_period(double dt_s) noexcept {
  const bool is_time = detail::is_valid(dt_s) && dt_s > 0.0;
  const double counted_s = is_time ? std::min(dt_s, kLongestPeriod_s) : kNominalPeriod_s;
  return {counted_s, std::min(counted_s, kLongestRise_s)};
}

double ramped(double scale, double change) noexcept {
  const double next = std::clamp(scale + change, 0.0, 1.0);
  if (next < kRampEnd) return 0.0;
  return next > 1.0 - kRampEnd ? 1.0 : next;
}

bool is_client_silent(const GateInput& input, const GateParams& params) noexcept {
  return !(input.silence_s <= params.stale_s);  // NaN counts as a timeout
}

bool is_too_fast(const GateInput& input, const GateParams& params) noexcept {
  return !(input.v_mm_per_s.norm() <= params.brake_mm_per_s);
}

/// Time above the brake's speed; it decreases at the same rate, so that an oscillation counts, too. Only with a force,
/// because otherwise the motors are not the cause.
void count_runaway(GateState& state, bool is_braking, double rise_s) noexcept {
  state.runaway_s = std::max(0.0, state.runaway_s + (is_braking ? rise_s : -rise_s));
}

/// Fault of this period. The caller's fault comes first: it names the cause.
telemetry::GateFault find_cause(const GateState& state, const GateInput& input, const GateParams& params,
                                bool is_valid) noexcept {
  if (input.device_fault > telemetry::kLastGateFault) return telemetry::GateFault::kNotFinite;
  if (input.device_fault != telemetry::GateFault::kNone) return input.device_fault;
  if (!is_valid) return telemetry::GateFault::kNotFinite;
  if (!(input.unread_s <= params.max_unread_s)) return telemetry::GateFault::kDeviceSilent;
  if (state.mode != telemetry::GateMode::kOff && detail::is_motion_impossible(state, input, params))
    return telemetry::GateFault::kImpossibleMotion;
  if (state.runaway_s > params.max_runaway_s + kSum_s) return telemetry::GateFault::kRunaway;
  if (detail::is_loop_slow(state, params)) return telemetry::GateFault::kLoopSlow;
  if (detail::is_vibrating(state)) return telemetry::GateFault::kVibration;
  if (state.fault == telemetry::GateFault::kRunaway && is_too_fast(input, params))
    return telemetry::GateFault::kRunaway;
  return telemetry::GateFault::kNone;
}

/// Safe start, fading and resume (physics.md G7): updates the mode and its scale.
void step_mode(GateState& state, const GateInput& input, const GateParams& params, const Period& period) noexcept {
  if (state.mode == telemetry::GateMode::kOff) {
    state.scale = 0.0;
    state.energy_mj = 0.0;
    if (input.is_wanted) state.mode = telemetry::GateMode::kWaiting;
  }
  const bool is_silent = is_client_silent(input, params);
  if (state.mode == telemetry::GateMode::kWaiting) {
    if (!input.is_wanted) state.mode = telemetry::GateMode::kOff;
    if (input.is_wanted && !is_silent && detail::is_small(input.wanted, params))
      state.mode = telemetry::GateMode::kRising;
    if (state.mode != telemetry::GateMode::kRising) return;
  }
  if (state.mode == telemetry::GateMode::kOff) return;
  if (!input.is_wanted || is_silent) {
    state.mode = telemetry::GateMode::kFading;
    state.scale = ramped(state.scale, -period.dt_s / params.fade_s);
    if (!input.is_wanted && state.scale == 0.0) state.mode = telemetry::GateMode::kOff;
    return;
  }
  state.scale = ramped(state.scale, period.rise_s / params.rise_s);
  state.mode = state.scale < 1.0 ? telemetry::GateMode::kRising : telemetry::GateMode::kOn;
}

/// Output during a fault: the last wrench on a linear ramp to zero.
Wrench fault_wrench(GateState& state, const GateParams& params, const Period& period) noexcept {
  const double before = state.scale;
  state.scale = ramped(before, -period.dt_s / params.fault_ramp_s);
  const double share = before > 0.0 ? state.scale / before : 0.0;
  state.watched = {share * state.watched.force_n, share * state.watched.torque_nmm};
  return {share * state.last.force_n, share * state.last.torque_nmm};
}

void latch(GateState& state, telemetry::GateFault cause) noexcept {
  state.fault = cause;
  state.mode = telemetry::GateMode::kFault;
  state.scale = 1.0;
}

void release(GateState& state) noexcept {
  state.fault = telemetry::GateFault::kNone;
  state.mode = telemetry::GateMode::kOff;
  state.scale = 0.0;
  state.runaway_s = state.vibration_s = 0.0;
}

/// Input of the period, with the tissue's wrench reduced to the share that the loop's period permits (physics.md G11).
GateInput weakened(const GateInput& input, double share) noexcept {
  GateInput weak = input;
  weak.wanted.force_n *= share;
  weak.wanted.torque_nmm *= share;
  return weak;
}

/// The stages of a period without a fault, up to the slew limit.
Wrench pass_stages(GateState& state, const GateInput& input, const GateParams& params, const Period& period,
                   bool is_braking, std::uint16_t& actions) noexcept {
  const detail::GateLimits limits = detail::warm_limits(state, params);
  Wrench wanted = detail::damp_energy(state, input, period.dt_s, limits, params, actions);
  if (is_braking) {
    wanted = detail::brake_wrench(input, params);
    actions |= kGateBrake;
  } else {
    wanted = {wanted.force_n + input.weight.force_n, wanted.torque_nmm + input.weight.torque_nmm};
  }
  if (wanted.force_n.norm() > limits.force_n) actions |= limits.is_force_warm ? kGateContinuous : kGateClamp;
  if (wanted.torque_nmm.norm() > limits.torque_nmm && params.peak_torque_nmm > 0.0)
    actions |= limits.is_torque_warm ? kGateContinuous : kGateClamp;
  wanted = detail::limited(wanted, input.axis, limits.force_n, limits.torque_nmm);
  const Vec3 rolled_nmm = detail::roll_limited(wanted.torque_nmm, input.axis, limits.roll_nmm);
  if (rolled_nmm != wanted.torque_nmm) actions |= limits.roll_nmm < params.peak_roll_nmm ? kGateContinuous : kGateClamp;
  wanted.torque_nmm = rolled_nmm;
  const Wrench target{state.scale * wanted.force_n, state.scale * wanted.torque_nmm};
  const Wrench out{
      detail::slew_limited(state.last.force_n, target.force_n, params.slew_n_per_s * period.rise_s),
      detail::slew_limited(state.last.torque_nmm, target.torque_nmm, params.slew_nmm_per_s * period.rise_s)};
  if (out.force_n != target.force_n || out.torque_nmm != target.torque_nmm) actions |= kGateSlew;
  const double weight_share = is_braking ? 0.0 : state.scale;
  state.watched = {out.force_n - weight_share * input.weight.force_n,
                   out.torque_nmm - weight_share * input.weight.torque_nmm};
  return out;
}

/// Tracks drops of the force; each one is reported once, at its end.
void follow_drop(GateState& state, double force_n, double dt_s, GateOutput& output) noexcept {
  const double last_n = state.last.force_n.norm();
  if (last_n - force_n > kFall_n_per_s * dt_s) {
    if (state.drop_s <= 0.0) state.drop_from_n = last_n;
    state.drop_s += dt_s;
    return;
  }
  if (state.drop_s > 0.0 && state.drop_from_n - last_n >= kLeastDrop_n) {
    output.drop_n = state.drop_from_n - last_n;
    output.drop_s = state.drop_s;
  }
  state.drop_from_n = state.drop_s = 0.0;
}

std::uint16_t mode_actions(telemetry::GateMode mode) noexcept {
  switch (mode) {
    case telemetry::GateMode::kOff:
      return kGateOff;
    case telemetry::GateMode::kWaiting:
    case telemetry::GateMode::kRising:
      return kGateStart;
    case telemetry::GateMode::kFault:
      return kGateFault;
    case telemetry::GateMode::kOn:
    case telemetry::GateMode::kFading:
    case telemetry::GateMode::kAbsent:
      break;
  }
  return 0;
}

}  // namespace

void restart_gate(GateState& state) noexcept {
  GateState fresh;
  fresh.fault = state.fault;
  fresh.mode = state.fault == telemetry::GateFault::kNone ? telemetry::GateMode::kOff : telemetry::GateMode::kFault;
  fresh.force_heat = state.force_heat;
  fresh.torque_heat = state.torque_heat;
  fresh.roll_heat = state.roll_heat;
  fresh.slow_s = state.fault == telemetry::GateFault::kLoopSlow ? state.slow_s : 0.0;
  state = fresh;
}

GateOutput step_gate(GateState& state, const GateInput& input, const GateParams& given) noexcept {
  const GateParams params = detail::made_safe(given);
  const Period period = make_period(input.dt_s);
  const bool is_input_valid = detail::is_valid(input);
  const bool is_valid = detail::restore(state) && is_input_valid;
  const bool is_braking =
      is_input_valid && state.scale > 0.0 && state.fault == telemetry::GateFault::kNone && is_too_fast(input, params);
  if (is_input_valid) {
    detail::watch_loop(state, input, period.rise_s, params);
    detail::watch_vibration(state, input, period.dt_s, params);
  }
  const GateInput given_input = weakened(input, state.coupling_share);
  if (is_input_valid) detail::observe_energy(state, given_input, period.dt_s, params);
  count_runaway(state, is_braking, period.rise_s);

  const telemetry::GateFault cause = find_cause(state, input, params, is_valid);
  if (state.fault == telemetry::GateFault::kNone && cause != telemetry::GateFault::kNone) latch(state, cause);
  if (state.fault != telemetry::GateFault::kNone && cause == telemetry::GateFault::kNone && input.is_reset)
    release(state);

  GateOutput output;
  Wrench out;
  if (state.fault != telemetry::GateFault::kNone) {
    out = fault_wrench(state, params, period);
  } else {
    step_mode(state, input, params, period);
    out = pass_stages(state, given_input, params, period, is_braking, output.actions);
    if (state.coupling_share < 1.0) output.actions |= kGateSlowLoop;
  }
  output.wrench = detail::limited(out, Vec3::Zero(), params.peak_force_n, params.peak_torque_nmm);
  if (is_input_valid)
    output.wrench.torque_nmm = detail::roll_limited(output.wrench.torque_nmm, input.axis, params.peak_roll_nmm);
  output.actions |= mode_actions(state.mode);
  if (is_client_silent(input, params)) output.actions |= kGateStale;
  follow_drop(state, output.wrench.force_n.norm(), period.dt_s, output);
  state.last = output.wrench;
  state.last_v_mm_per_s = is_input_valid ? input.v_mm_per_s : Vec3(Vec3::Zero());
  detail::warm(state, is_input_valid ? input.axis : Vec3(Vec3::Zero()), period.dt_s, params);
  return output;
}

}  // namespace trocar::haptics
