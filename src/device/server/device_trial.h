#pragma once

#include <optional>

#include "devices/haptic_device.h"
#include "haptics/gate/safety_gate.h"

namespace trocar::server {

/// Result of one period of a trial.
struct DeviceTrialRecord {
  devices::DeviceReading reading;
  haptics::Wrench written_D;
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  bool is_pushing = false;
};

/// Tests a device without a patient: reads its pose and applies a small force on request. One period: read, gate,
/// write; only the gate's output is written. Time is an argument; real-time safe.
class DeviceTrial {
 public:
  DeviceTrial(devices::HapticDevice& device, double rate_hz) noexcept;

  DeviceTrialRecord step(double now_s, double dt_s) noexcept;
  /// Applies a force upwards (+z of D) that rises to push_n() and falls again within kPush_s, after the safe start of
  /// the gate. Resets a fault of the previous push.
  void push() noexcept;
  /// Peak force of the push: 0.6 of the continuous force, at most 1 N; 3 N for a device that only displays forces
  /// (rumble).
  double push_n() const noexcept { return push_n_; }

  static constexpr double kPush_s = 1.5;

 private:
  devices::HapticDevice& device_;
  const haptics::GateParams gate_;
  const double push_n_;
  haptics::GateState state_;
  std::optional<double> pushing_s_;  ///< Time of the push after the safe start.
  std::optional<Pose> last_X_DS_;
  double unread_s_ = 0.0;
  bool is_reset_ = false;
  bool has_refused_ = false;  ///< The device did not take the last wrench.
};

}  // namespace trocar::server
