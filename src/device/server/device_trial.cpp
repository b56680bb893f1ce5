#include "server/device_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/result.h"
#include "haptics/gate/gate_params.h"
#include "stylus/virtual_stylus.h"

namespace trocar::server {
namespace {

constexpr double kMostPush_n = 1.0;   ///< Noticeable, but does not push the hand away. [assumed]
constexpr double kShare = 0.6;        ///< Share of the continuous force. [assumed]
constexpr double kShownPush_n = 3.0;  ///< For a gamepad, half of its rumble.
/// A trial has no stiff spring; more damping of single encoder counts would be felt as clicks. [assumed]
constexpr double kMostDamping_ns_per_mm = 0.005;

haptics::GateParams trial_gate(const stylus::DevicePreset& preset, double rate_hz) noexcept {
  haptics::GateParams params = haptics::gate_params(preset);
  params.period_s = 1.0 / rate_hz;
  params.max_damping_ns_per_mm = std::min(params.max_damping_ns_per_mm, kMostDamping_ns_per_mm);
  return params;
}

double push_of(const stylus::DevicePreset& preset, const haptics::GateParams& gate) noexcept {
  return preset.has_force() ? std::min(kMostPush_n, kShare * gate.continuous_force_n) : kShownPush_n;
}

}  // namespace

DeviceTrial::DeviceTrial(devices::HapticDevice& device, double rate_hz) noexcept
    : device_(device),
      gate_(trial_gate(device.preset(), rate_hz)),
      push_n_(push_of(device.preset(), gate_)),
      weighing_(device.preset(), gate_) {}

void DeviceTrial::push() noexcept {
  if (weighing_.is_running()) return;
  pushing_s_ = 0.0;
  is_reset_ = true;
}

void DeviceTrial::weigh(const std::optional<Pose>& placed_X_DS) noexcept {
  if (weighing_.is_running()) return;
  pushing_s_.reset();
  placed_X_DS_ = placed_X_DS;
  is_placed_ = false;
  is_reset_ = true;
  weighing_.start();
}

/// Faults and velocities of a reading.
haptics::GateInput DeviceTrial::sense(const devices::DeviceReading& now, double dt_s) noexcept {
  const bool is_fresh = now.status == devices::DeviceStatus::kFresh;
  const double since_fresh_s = age_.advance(is_fresh, dt_s, gate_.max_unread_s);
  haptics::GateInput input;
  input.dt_s = dt_s;
  input.unread_s = age_.unread_s();
  input.is_reset = is_reset_;
  if (now.status == devices::DeviceStatus::kDisconnected || (has_refused_ && !is_reset_))
    input.device_fault = telemetry::GateFault::kDeviceLost;
  is_reset_ = false;
  if (!now.X_DS.is_finite()) input.device_fault = telemetry::GateFault::kNotFinite;
  if (is_fresh && now.X_DS.is_finite()) {
    if (last_X_DS_) {
      input.v_mm_per_s = (now.X_DS.p() - last_X_DS_->p()) / since_fresh_s;
      input.w_rad_per_s = rotation_vector(now.X_DS.R() * last_X_DS_->R().transpose()) / since_fresh_s;
    }
    last_X_DS_ = now.X_DS;
  }
  return input;
}

void DeviceTrial::ask_push(haptics::GateInput& input) noexcept {
  input.is_wanted = true;
  if (state_.mode == telemetry::GateMode::kOn) *pushing_s_ += input.dt_s;  // not during the safe start
  const double share = std::sin(std::numbers::pi * std::min(*pushing_s_ / kPush_s, 1.0));
  input.wanted.force_n = push_n_ * share * share * Vec3::UnitZ();
  if (*pushing_s_ >= kPush_s) pushing_s_.reset();
}

void DeviceTrial::ask_weighing(const devices::DeviceReading& now, haptics::GateInput& input) noexcept {
  StylusWeighing::Input period;
  if (now.status == devices::DeviceStatus::kFresh && now.X_DS.is_finite()) period.X_DS = now.X_DS;
  period.written_D = state_.last;
  period.mode = state_.mode;
  period.dt_s = input.dt_s;
  const StylusWeighing::Demand demand = weighing_.step(period);
  input.wanted = demand.wanted_D;
  input.weight = demand.weight_D;
  input.is_wanted = demand.is_wanted;
  input.coupling = weighing_.coupling();
  if (last_X_DS_) input.axis = last_X_DS_->R().col(2);
}

/// Places the stylus, holds it, and lets go. Devices that a person holds ignore it.
void DeviceTrial::move_simulated_hand(double now_s) noexcept {
  if (!weighing_.is_running() && !is_placed_) placed_X_DS_.reset();  // refused at once
  if (!placed_X_DS_ || device_.is_in_real_hand()) return;
  const bool is_held = weighing_.needs_hand();
  if (is_held && (is_placed_ || state_.mode != telemetry::GateMode::kOff)) return;
  const stylus::StylusHold made = stylus::make_hand();
  devices::DeviceHand hand;
  hand.X_DS = *placed_X_DS_;
  hand.time_s = now_s;
  hand.stiffness_n_per_mm = made.stiffness_n_per_mm;
  hand.damping_ns_per_mm = made.damping_ns_per_mm;
  hand.mass_kg = made.mass_kg;
  hand.turning_nmm_per_rad = made.turning_nmm_per_rad;
  hand.turning_damping_nmms_per_rad = made.turning_damping_nmms_per_rad;
  hand.inertia_kg_mm2 = made.inertia_kg_mm2;
  hand.is_held = is_held;
  hand.is_placed = !is_placed_;
  device_.hold(hand);
  is_placed_ = true;
  if (!is_held) placed_X_DS_.reset();
}

DeviceTrialRecord DeviceTrial::step(double now_s, double dt_s) noexcept {
  DeviceTrialRecord record;
  record.reading = device_.read(now_s);
  move_simulated_hand(now_s);
  haptics::GateInput input = sense(record.reading, dt_s);
  if (pushing_s_) ask_push(input);
  if (weighing_.is_running()) ask_weighing(record.reading, input);
  const bool is_plugged_in = record.reading.status != devices::DeviceStatus::kDisconnected;
  const bool is_off = has_refused_ && is_plugged_in;
  const haptics::GateOutput output = haptics::step_gate(state_, input, gate_);
  if (state_.fault != telemetry::GateFault::kNone) {
    pushing_s_.reset();
    if (weighing_.is_running()) weighing_.abort(is_off ? WeighRefusal::kForcesOff : WeighRefusal::kFault, state_.fault);
  }
  has_refused_ = !device_.write(output.wrench);
  record.written_D = output.wrench;
  record.fault = state_.fault;
  record.is_pushing = pushing_s_.has_value();
  record.is_weighing = weighing_.is_running();
  record.weighed = weighing_.take_result();
  return record;
}

namespace {

constexpr double kLargeTilt = 0.1;  // horizontal force of the weight: a base tilted by 6 degrees [assumed]
constexpr double kLargePull_n = 0.05;

struct Refusal {
  std::string what, advice;
};

Refusal refusal_of(const WeighResult& result) {
  switch (result.refusal) {
    case WeighRefusal::kNone:
      break;
    case WeighRefusal::kNoForce:
      return {"the device gives no force and cannot weigh its stylus", "weigh on a device with motors"};
    case WeighRefusal::kCarriedByDevice:
      return {"the weight in the device's preset is 0: the device carries its stylus itself",
              "use it without a weighing; an attachment must be balanced by the vendor's settings"};
    case WeighRefusal::kForcesOff:
      return {"the device accepts no forces", "switch its forces on (force button, power), and weigh again"};
    case WeighRefusal::kFault:
      return {fmt::format("a fault ended the forces: {}", telemetry::to_string(result.fault)),
              "check the device with push, then weigh again"};
    case WeighRefusal::kNotAtRest:
      return {"the stylus did not come to rest", "let it go when the device holds it, and keep cables free"};
    case WeighRefusal::kMoved:
      return {"the stylus was moved away", "hold it still until the device holds it, then let go"};
    case WeighRefusal::kHeld:
      return {"the stylus did not follow the device: a hand, its holder or an end stop holds it",
              "let go of it in the middle of the workspace, and weigh again"};
    case WeighRefusal::kUnsteady:
      return {fmt::format("the force was not constant (within {:.2f} N)", result.spread_n),
              "let go of the stylus, keep cables free, and weigh again"};
    case WeighRefusal::kTooHeavy:
      return {fmt::format("the stylus is heavier than the {:.2f} N that the device can hold for long, or held down",
                          result.limit_n),
              "take a lighter attachment, or let go of the stylus"};
    case WeighRefusal::kPullsUp:
      return {fmt::format("the arm pulls upwards with {:.2f} N", -result.weight_n), "lessen its counterweight"};
  }
  TROCAR_CHECK(false);
  return {};
}

}  // namespace

Error weigh_error(const WeighResult& result, const std::string& device) {
  const Refusal refusal = refusal_of(result);
  return {refusal.what, device, refusal.advice};
}

std::string weigh_text(const WeighResult& result, const stylus::DevicePreset& preset) {
  const stylus::DeviceCapability& device = preset.capability;
  std::string text = fmt::format("The stylus weighs {:.2f} N (preset: {:.2f} N); friction {:.2f} N.", result.weight_n,
                                 device.stylus_weight_n, result.friction_n);
  if (result.lever_mm)
    text += fmt::format(" Its centre of mass is {:.0f} mm behind the grip (preset: {:.0f} mm).", *result.lever_mm,
                        device.stylus_lever_mm);
  else if (!preset.has_torque())
    text += " The device has no torque: the lever is not measured.";
  else
    text += " The lever is not measured: hold the stylus level for it.";
  if (result.horizontal_n > kLargePull_n + kLargeTilt * result.weight_n)
    text +=
        fmt::format(" A horizontal force of {:.2f} N shows a tilted base or a cable that pulls.", result.horizontal_n);
  return text;
}

}  // namespace trocar::server
