#include "haptics/gate/gate_stages.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "haptics/gate/gate_params.h"

namespace trocar::haptics::detail {
namespace {

constexpr double kMostPlausible = 1e6;      // of any unit: a force, a speed, a position of no device [assumed]
constexpr double kDampingLever_mm = 20.0;   // turns damping of a force into that of a torque, b l^2 [assumed, 10..40]
constexpr double kLeastSpeed_mm_per_s = 1;  // below it damping takes nothing worth the noise [assumed, 0.1..5]
constexpr double kMostExcess_mj = 100.0;    // remembered beyond the margin [assumed, 20..500]
constexpr double kFriction_n = 0.05;        // that every device has in its joints [assumed, 0.02..0.2]
constexpr double kQuiet_s = 0.25;           // without force, after which an excess is over [assumed, 0.1..1]
constexpr double kCool = 0.8;               // share of the continuous heat up to which the peak is allowed [assumed]
constexpr double kLateralShare = 0.2;  // of the force's limit that an axial force leaves to a lateral one [assumed]
constexpr double kLeastAxis = 1e-6;    // length below which an axis has no direction
constexpr double kRounding = 1e-12;    // relative margin that keeps a limited norm below its limit

bool is_valid(const Vec3& value) noexcept {
  return detail::is_valid(value.x()) && detail::is_valid(value.y()) && detail::is_valid(value.z());
}

Vec3 clipped(const Vec3& value, double limit) noexcept {
  const double norm = value.norm();
  if (norm <= limit * (1.0 - kRounding)) return value;
  return norm > 0.0 ? Vec3(value * (limit * (1.0 - kRounding) / norm)) : Vec3(Vec3::Zero());
}

/// Energy stored in a spring with the demand `wanted` and the limit `limit`.
double spring_energy_mj(double wanted, double limit, double stiffness) noexcept {
  const double given = std::min(wanted, limit);
  return given * (wanted - 0.5 * given) / stiffness;
}

/// Work of a force along a quantised displacement: `before` acted, for the last count possibly `now`; this uncertainty
/// is worth at most the device's friction.
double work_mj(const Vec3& before, const Vec3& now, const Vec3& way, double count, double friction) noexcept {
  const double length = way.norm();
  if (length <= 0.0) return 0.0;
  const double uncertain = 0.5 * std::min(1.0, count / length) * (now - before).dot(way);
  return before.dot(way) + std::clamp(uncertain, -friction * length, friction * length);
}

double damping_lever_mm(const GateParams& params) noexcept {
  return params.peak_torque_nmm > 0.0 ? kDampingLever_mm : 0.0;
}

Wrench damping(double b_ns_per_mm, const GateInput& input, const GateParams& params) noexcept {
  const double lever_mm = damping_lever_mm(params);
  return {-b_ns_per_mm * input.v_mm_per_s, -b_ns_per_mm * lever_mm * lever_mm * input.w_rad_per_s};
}

double warm_limit(double heat, double peak, double continuous) noexcept {
  const double t = std::clamp((heat - kCool) / (1.0 - kCool), 0.0, 1.0);
  return peak + (continuous - peak) * (t * t * (3.0 - 2.0 * t));
}

double warmed(double heat, double norm, double continuous, double share) noexcept {
  if (continuous <= 0.0) return heat * (1.0 - share);
  const double ratio = norm / continuous;
  return heat + share * (ratio * ratio - heat);
}

}  // namespace

bool is_valid(double value) noexcept {
  return std::abs(value) <= kMostPlausible;  // false for NaN
}

bool is_valid(const Wrench& wrench) noexcept {
  return is_valid(wrench.force_n) && is_valid(wrench.torque_nmm);
}

bool is_valid(const GateInput& input) noexcept {
  return is_valid(input.wanted) && is_valid(input.weight) && is_valid(input.axis) && is_valid(input.v_mm_per_s) &&
         is_valid(input.w_rad_per_s) && is_valid(input.dt_s) && input.dt_s > 0.0 && is_valid(input.busy_s) &&
         is_valid(input.coupling.stiffness_n_per_mm) && is_valid(input.coupling.damping_ns_per_mm);
}

bool is_small(const Wrench& wrench, const GateParams& params) noexcept {
  return wrench.force_n.norm() < params.small_force_n && wrench.torque_nmm.norm() < params.small_torque_nmm;
}

bool restore(GateState& state) noexcept {
  const bool is_watch_valid =
      state.slow_s >= 0.0 && is_valid(state.slow_s) && state.since_late_s >= 0.0 && is_valid(state.since_late_s) &&
      state.slow_period_s >= 0.0 && is_valid(state.slow_period_s) && state.coupling_share >= 0.0 &&
      state.coupling_share <= 1.0 && is_valid(state.slow_f_n) && is_valid(state.slow_tau_nmm) &&
      is_valid(state.slow_v_mm_per_s) && is_valid(state.slow_w_rad_per_s) && is_valid(state.last_v_mm_per_s) &&
      std::isfinite(state.vibration_mw) && is_valid(state.vibration_s);
  const bool is_state_valid =
      is_watch_valid && is_valid(state.last) && is_valid(state.watched) && state.scale >= 0.0 && state.scale <= 1.0 &&
      std::isfinite(state.energy_mj) && state.force_heat >= 0.0 && std::isfinite(state.force_heat) &&
      state.torque_heat >= 0.0 && std::isfinite(state.torque_heat) && state.roll_heat >= 0.0 &&
      std::isfinite(state.roll_heat) && is_valid(state.runaway_s) && is_valid(state.quiet_s) &&
      is_valid(state.drop_from_n) && is_valid(state.drop_s) && state.mode <= telemetry::GateMode::kFault &&
      state.fault <= telemetry::kLastGateFault &&
      (state.mode == telemetry::GateMode::kFault) == (state.fault != telemetry::GateFault::kNone);
  if (is_state_valid) return true;
  const telemetry::GateFault fault =
      state.fault <= telemetry::kLastGateFault ? state.fault : telemetry::GateFault::kNotFinite;
  state = GateState{};
  state.fault = fault;
  state.mode = fault == telemetry::GateFault::kNone ? telemetry::GateMode::kOff : telemetry::GateMode::kFault;
  state.force_heat = state.torque_heat = state.roll_heat = 1.0;  // unknown motor temperature: the maximum is assumed
  return false;
}

void observe_energy(GateState& state, const GateInput& input, double dt_s, const GateParams& params) noexcept {
  const Wrench now = limited(input.wanted, input.axis, params.peak_force_n, params.peak_torque_nmm);
  state.energy_mj +=
      work_mj(state.watched.force_n, state.scale * now.force_n, dt_s * input.v_mm_per_s, params.count_mm, kFriction_n) +
      work_mj(state.watched.torque_nmm, state.scale * now.torque_nmm, dt_s * input.w_rad_per_s, params.count_rad,
              kFriction_n * kDampingLever_mm);
  state.quiet_s = is_small(input.wanted, params) ? std::min(state.quiet_s + dt_s, kQuiet_s) : 0.0;
  if (state.quiet_s >= kQuiet_s) state.energy_mj = std::min(state.energy_mj, 0.0);
  const double stored_mj =
      spring_energy_mj(input.wanted.force_n.norm(), params.peak_force_n, params.softest_n_per_mm) +
      spring_energy_mj(input.wanted.torque_nmm.norm(), params.peak_torque_nmm, params.softest_nmm_per_rad);
  state.energy_mj =
      std::clamp(state.energy_mj, -params.passivity_margin_mj - stored_mj, params.passivity_margin_mj + kMostExcess_mj);
}

Wrench damp_energy(const GateState& state, const GateInput& input, double dt_s, const GateLimits& limits,
                   const GateParams& params, std::uint16_t& actions) noexcept {
  const Wrench given = limited(input.wanted, input.axis, limits.force_n, limits.torque_nmm);
  const double power = given.force_n.dot(input.v_mm_per_s) + given.torque_nmm.dot(input.w_rad_per_s);
  const double excess_mj = state.energy_mj + state.scale * power * dt_s - params.passivity_margin_mj;
  const double speed = std::hypot(input.v_mm_per_s.norm(), damping_lever_mm(params) * input.w_rad_per_s.norm());
  if (!(excess_mj > 0.0) || speed < kLeastSpeed_mm_per_s || params.max_damping_ns_per_mm <= 0.0) return input.wanted;
  actions |= kGatePassivity;
  const Wrench brake =
      damping(std::min(excess_mj / (speed * speed * dt_s), params.max_damping_ns_per_mm), input, params);
  return {given.force_n + brake.force_n, given.torque_nmm + brake.torque_nmm};
}

Wrench brake_wrench(const GateInput& input, const GateParams& params) noexcept {
  return damping(params.brake_ns_per_mm, input, params);
}

GateLimits warm_limits(const GateState& state, const GateParams& params) noexcept {
  GateLimits limits;
  limits.force_n = warm_limit(state.force_heat, params.peak_force_n, params.continuous_force_n);
  limits.torque_nmm = warm_limit(state.torque_heat, params.peak_torque_nmm, params.continuous_torque_nmm);
  limits.roll_nmm = warm_limit(state.roll_heat, params.peak_roll_nmm, params.continuous_roll_nmm);
  limits.is_force_warm = limits.force_n < params.peak_force_n;
  limits.is_torque_warm = limits.torque_nmm < params.peak_torque_nmm;
  return limits;
}

void warm(GateState& state, const Vec3& axis, double dt_s, const GateParams& params) noexcept {
  const double share = -std::expm1(-dt_s / params.thermal_time_s);
  state.force_heat = warmed(state.force_heat, state.last.force_n.norm(), params.continuous_force_n, share);
  state.torque_heat = warmed(state.torque_heat, state.last.torque_nmm.norm(), params.continuous_torque_nmm, share);
  const double roll_nmm = std::abs(roll_of(state.last.torque_nmm, axis));
  state.roll_heat = warmed(state.roll_heat, roll_nmm, params.continuous_roll_nmm, share);
}

Vec3 slew_limited(const Vec3& last, const Vec3& target, double most) noexcept {
  const double norm = last.norm();
  Vec3 kept = Vec3::Zero();
  if (norm > 0.0) {
    const Vec3 direction = last / norm;
    kept = std::clamp(target.dot(direction), 0.0, norm) * direction;
  }
  const Vec3 rise = target - kept;
  return rise.norm() <= most ? target : Vec3(kept + clipped(rise, most));
}

Wrench limited(const Wrench& wrench, const Vec3& axis, double force_n, double torque_nmm) noexcept {
  Wrench result = wrench;
  const double norm = wrench.force_n.norm();
  const double length = axis.norm();
  if (norm > force_n) {
    const Vec3 along = length > kLeastAxis ? Vec3(axis / length) : Vec3(Vec3::Zero());
    const double axial_n = wrench.force_n.dot(along);
    const Vec3 lateral_n = wrench.force_n - axial_n * along;
    const double across_n = lateral_n.norm();
    const double room_n = std::max(std::sqrt(std::max(0.0, force_n * force_n - axial_n * axial_n)),
                                   std::min(across_n, kLateralShare * force_n));
    const double factor = across_n > room_n ? room_n / across_n : 1.0;
    const double left_n = std::sqrt(std::max(0.0, force_n * force_n - factor * across_n * factor * across_n));
    result.force_n = std::clamp(axial_n, -left_n, left_n) * along + factor * lateral_n;
    result.torque_nmm = factor * wrench.torque_nmm;
  }
  return {clipped(result.force_n, force_n), clipped(result.torque_nmm, torque_nmm)};
}

double roll_of(const Vec3& torque_nmm, const Vec3& axis) noexcept {
  const double length = axis.norm();
  return length > kLeastAxis ? torque_nmm.dot(axis) / length : 0.0;
}

Vec3 roll_limited(const Vec3& torque_nmm, const Vec3& axis, double most) noexcept {
  const double roll_nmm = roll_of(torque_nmm, axis);
  if (!(most > 0.0) || std::abs(roll_nmm) <= most) return torque_nmm;
  return torque_nmm + (std::clamp(roll_nmm, -most, most) - roll_nmm) / axis.norm() * axis;
}

}  // namespace trocar::haptics::detail

/// Monitors of the safety gate: the loop's period, impossible motion, vibration (physics.md G11-G13).
namespace trocar::haptics::detail {
namespace {

constexpr double kOwnShare = 0.5;          // share of a late period in the loop's own calls: then it will be late again
constexpr double kMemory_s = 0.05;         // one gap within it is tolerated [assumed]
constexpr double kCutoff_hz = 30.0;        // hand motion is slower: tremor ends at 12 Hz [assumed]
constexpr double kMean_s = 0.05;           // averaging time of the power [assumed]
constexpr double kMostVibration_s = 0.02;  // above the limit before a fault; longer than a puncture [assumed]
constexpr double kMostPower_mw = 1e9;      // bound that keeps the power finite

/// One period of a high-pass filter.
Vec3 high_passed(Vec3& slow, const Vec3& value, double share) noexcept {
  slow += share * (value - slow);
  return value - slow;
}

}  // namespace

void watch_loop(GateState& state, const GateInput& input, double rise_s, const GateParams& params) noexcept {
  const bool is_late = input.dt_s > longest_period_s(input.coupling, params);
  const bool is_own = input.busy_s > kOwnShare * input.dt_s;
  const bool is_slow = is_late && (is_own || state.since_late_s < kMemory_s);
  const bool is_forceful = input.coupling.stiffness_n_per_mm > 0.0 && state.scale > 0.0;
  const bool is_counted = is_forceful || state.fault == telemetry::GateFault::kLoopSlow;
  const double late_s = (is_own ? 2.0 : 1.0) * input.dt_s;
  state.slow_s =
      std::clamp(state.slow_s + (is_late && is_counted ? late_s : -input.dt_s), 0.0, 2.0 * params.max_slow_s);
  state.since_late_s = is_late ? 0.0 : std::min(state.since_late_s + input.dt_s, 1.0);
  if (is_slow) state.slow_period_s = std::max(state.slow_period_s, input.dt_s);
  if (state.since_late_s >= kMemory_s) state.slow_period_s = 0.0;

  const double period_s = std::max(state.slow_period_s, params.period_s);
  const double permitted = permitted_share(input.coupling, period_s, params);
  state.coupling_share = std::min(permitted, state.coupling_share + rise_s / params.rise_s);
}

bool is_loop_slow(const GateState& state, const GateParams& params) noexcept {
  constexpr double kSum_s = 1e-9;  // rounding of a sum of periods
  return state.slow_s >= params.max_slow_s - kSum_s;
}

bool is_motion_impossible(const GateState& state, const GateInput& input, const GateParams& params) noexcept {
  const double dt_s = input.dt_s;
  const bool is_step = dt_s * input.v_mm_per_s.norm() > params.jump_mm + params.hand_mm_per_s * dt_s;
  const double off_way_mm = dt_s * (input.v_mm_per_s - state.last_v_mm_per_s).norm();
  const bool is_kick = off_way_mm > params.kick_mm + params.thrust_mm_per_s2 * dt_s * dt_s;
  const bool is_turn = dt_s * input.w_rad_per_s.norm() > params.turn_rad + params.hand_rad_per_s * dt_s;
  return is_step || is_kick || is_turn;
}

void watch_vibration(GateState& state, const GateInput& input, double dt_s, const GateParams& params) noexcept {
  if (state.scale <= 0.0) {
    state.slow_f_n = state.slow_tau_nmm = state.slow_v_mm_per_s = state.slow_w_rad_per_s = Vec3::Zero();
    state.vibration_mw = state.vibration_s = 0.0;
    return;
  }
  const double share = -std::expm1(-2.0 * std::numbers::pi * kCutoff_hz * dt_s);
  const Vec3 f_n = high_passed(state.slow_f_n, state.watched.force_n, share);
  const Vec3 tau_nmm = high_passed(state.slow_tau_nmm, state.watched.torque_nmm, share);
  const Vec3 v_mm_per_s = high_passed(state.slow_v_mm_per_s, input.v_mm_per_s, share);
  const Vec3 w_rad_per_s = high_passed(state.slow_w_rad_per_s, input.w_rad_per_s, share);
  const double power_mw = f_n.dot(v_mm_per_s) + tau_nmm.dot(w_rad_per_s);
  state.vibration_mw += -std::expm1(-dt_s / kMean_s) * (power_mw - state.vibration_mw);
  state.vibration_mw = std::clamp(state.vibration_mw, -params.max_vibration_mw, kMostPower_mw);
  const bool is_above = state.vibration_mw > params.max_vibration_mw;
  state.vibration_s = std::clamp(state.vibration_s + (is_above ? dt_s : -dt_s), 0.0, 2.0 * kMostVibration_s);
}

bool is_vibrating(const GateState& state) noexcept {
  return state.vibration_s >= kMostVibration_s;
}

}  // namespace trocar::haptics::detail
