#include "lab/server/slow_loop_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "devices/pointer/pointer_device.h"
#include "devices/simulated/faulty_device.h"
#include "devices/simulated/virtual_haptic_device.h"

namespace trocar::server {
namespace {

constexpr double kPeriod_s = 0.001;
constexpr double kApproach_mm_per_s = 20.0;
constexpr double kStart_mm = -10.0;

std::unique_ptr<devices::HapticDevice> make_simulated(const stylus::DevicePreset& preset) {
  if (!preset.has_force()) return std::make_unique<devices::PointerDevice>(preset, devices::PointerParams{});
  return std::make_unique<devices::VirtualHapticDevice>(preset, devices::SimulatedDeviceParams{});
}

/// Down to the upper end of its oscillation, then up and down.
link::HandTarget hand_at(const SlowLoopTrial& trial, double time_s) {
  const double top_mm = trial.depth_mm - trial.swing_mm;
  const double begun_s = (top_mm - kStart_mm) / kApproach_mm_per_s;
  const double omega = 2.0 * std::numbers::pi * trial.swing_hz;
  const double phase = omega * (time_s - begun_s);
  const bool is_swinging = phase > 0.0;
  link::HandTarget hand;
  const double depth_mm =
      is_swinging ? trial.depth_mm - trial.swing_mm * std::cos(phase) : kStart_mm + kApproach_mm_per_s * time_s;
  hand.X_PN = needle_pose({0.0, 0.0, depth_mm}, Vec3::UnitZ());
  hand.v_P.z() = is_swinging ? trial.swing_mm * omega * std::sin(phase) : kApproach_mm_per_s;
  hand.server_time_s = time_s;
  hand.is_placed = time_s <= kPeriod_s;
  return hand;
}

void count_wait(void* waited_s, double wait_ms) noexcept {
  *static_cast<double*>(waited_s) += 1e-3 * wait_ms;
}

}  // namespace

SlowLoopOutcome run_slow_loop_trial(const ServoScene& scene, const stylus::DevicePreset& preset,
                                    const SlowLoopTrial& trial) {
  double waited_s = 0.0;
  const bool is_healthy = trial.slow_ms <= 0.0;
  const devices::ScheduledFault fault{trial.fault, is_healthy ? trial.end_s : trial.fault_s,
                                      std::numeric_limits<double>::infinity(), trial.slow_ms};
  devices::FaultyDevice device(make_simulated(preset), {fault}, 1, {count_wait, &waited_s});
  Servo servo(device, servo_params(preset));

  SlowLoopOutcome outcome;
  outcome.zero_s = std::numeric_limits<double>::infinity();
  Eigen::AlignedBox3d travel;
  ServoInput input;
  input.scene = &scene;
  input.is_wanted = true;
  int slow_periods = 0;
  double begun_s = trial.fault_s;
  while (input.now_s < trial.end_s) {
    input.busy_s = std::exchange(waited_s, 0.0);
    // Grid of the loop: late periods are skipped.
    input.dt_s = kPeriod_s * (std::floor(input.busy_s / kPeriod_s + 1e-9) + 1.0);
    if (input.busy_s > 0.0 && slow_periods++ == 0) begun_s = input.now_s;
    input.now_s += input.dt_s;
    input.hand = hand_at(trial, input.now_s);
    const ServoRecord record = servo.step(input);
    const double written_n = record.written_D.force_n.norm();
    if (input.now_s < trial.fault_s) {
      outcome.before_n = std::max(outcome.before_n, written_n);
      continue;
    }
    outcome.longest_period_s = std::max(outcome.longest_period_s, input.dt_s);
    outcome.after_n = std::max(outcome.after_n, written_n);
    outcome.least_share = std::min(outcome.least_share, record.sample.coupling_share);
    travel.extend(record.X_DS.p());
    const double since_s = input.now_s - begun_s;
    if (written_n > 0.0) {
      outcome.zero_s = std::numeric_limits<double>::infinity();
    } else {
      outcome.zero_s = std::min(outcome.zero_s, since_s);
    }
    if (record.sample.gate_fault != telemetry::GateFault::kNone && outcome.fault == telemetry::GateFault::kNone) {
      outcome.fault = record.sample.gate_fault;
      outcome.latch_s = since_s;
      outcome.latch_periods = slow_periods;
    }
  }
  outcome.travel_mm = travel.sizes().maxCoeff();
  return outcome;
}

}  // namespace trocar::server
