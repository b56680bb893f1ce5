#include "server/device_trial.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "haptics/closed_loop/rotation.h"
#include "haptics/gate/device_gate.h"

namespace trocar::server {
namespace {

constexpr double kMostPush_n = 1.0;   ///< Noticeable, but does not push the hand away. [assumed]
constexpr double kShare = 0.6;        ///< Share of the continuous force. [assumed]
constexpr double kShownPush_n = 3.0;  ///< For a gamepad, half of its rumble.

haptics::GateParams trial_gate(const haptics::DevicePreset& preset, double rate_hz) noexcept {
  haptics::GateParams params = haptics::gate_params(preset);
  params.period_s = 1.0 / rate_hz;
  return params;
}

double push_of(const haptics::DevicePreset& preset, const haptics::GateParams& gate) noexcept {
  return preset.has_force() ? std::min(kMostPush_n, kShare * gate.continuous_force_n) : kShownPush_n;
}

}  // namespace

DeviceTrial::DeviceTrial(devices::HapticDevice& device, double rate_hz) noexcept
    : device_(device), gate_(trial_gate(device.preset(), rate_hz)), push_n_(push_of(device.preset(), gate_)) {}

void DeviceTrial::push() noexcept {
  pushing_s_ = 0.0;
  is_reset_ = true;
}

DeviceTrialRecord DeviceTrial::step(double now_s, double dt_s) noexcept {
  DeviceTrialRecord record;
  record.reading = device_.read(now_s);
  const devices::DeviceReading& now = record.reading;
  const double since_fresh_s = unread_s_ + dt_s;
  unread_s_ = now.status == devices::DeviceStatus::kFresh ? 0.0 : since_fresh_s;

  haptics::GateInput input;
  input.dt_s = dt_s;
  input.unread_s = unread_s_;
  input.is_reset = is_reset_;
  if (now.status == devices::DeviceStatus::kDisconnected || (has_refused_ && !is_reset_))
    input.device_fault = telemetry::GateFault::kDeviceLost;
  is_reset_ = false;
  if (!now.X_DS.is_finite()) input.device_fault = telemetry::GateFault::kNotFinite;
  if (now.status == devices::DeviceStatus::kFresh && now.X_DS.is_finite()) {
    if (last_X_DS_) {
      input.v_mm_per_s = (now.X_DS.p() - last_X_DS_->p()) / since_fresh_s;
      input.w_rad_per_s = haptics::rotation_vector(now.X_DS.R() * last_X_DS_->R().transpose()) / since_fresh_s;
    }
    last_X_DS_ = now.X_DS;
  }
  input.is_wanted = pushing_s_.has_value();
  if (pushing_s_) {
    if (state_.mode == telemetry::GateMode::kOn) *pushing_s_ += dt_s;  // not during the safe start
    const double share = std::sin(std::numbers::pi * std::min(*pushing_s_ / kPush_s, 1.0));
    input.wanted.force_n = push_n_ * share * share * Vec3::UnitZ();
    if (*pushing_s_ >= kPush_s) pushing_s_.reset();
  }
  const haptics::GateOutput output = haptics::step_gate(state_, input, gate_);
  if (state_.fault != telemetry::GateFault::kNone) pushing_s_.reset();
  has_refused_ = !device_.write(output.wrench);
  record.written_D = output.wrench;
  record.fault = state_.fault;
  record.is_pushing = pushing_s_.has_value();
  return record;
}

}  // namespace trocar::server
