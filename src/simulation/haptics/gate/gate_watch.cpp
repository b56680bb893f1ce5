#include <algorithm>
#include <cmath>
#include <numbers>

#include "haptics/gate/detail/gate_stages.h"
#include "haptics/gate/loop_limits.h"

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
