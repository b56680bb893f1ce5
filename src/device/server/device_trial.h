#pragma once

#include <optional>
#include <string>

#include "core/result.h"
#include "devices/haptic_device.h"
#include "haptics/gate/safety_gate.h"
#include "server/detail/pose_hold.h"
#include "server/stylus_weighing.h"

namespace trocar::server {

/// Result of one period of a trial.
struct DeviceTrialRecord {
  devices::DeviceReading reading;
  Wrench written_D;
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  bool is_pushing = false;
  bool is_weighing = false;
  std::optional<WeighResult> weighed;  ///< In the period in which a weighing ended.
};

/// Tests a device without a patient: reads its pose, and applies a small force or weighs its stylus on request. One
/// period: read, gate, write; only the gate's output is written. Time is an argument; real-time safe.
class DeviceTrial {
 public:
  DeviceTrial(devices::HapticDevice& device, double rate_hz) noexcept;

  DeviceTrialRecord step(double now_s, double dt_s) noexcept;
  /// Applies a force upwards (+z of D) that rises to push_n() and falls again within kPush_s, after the safe start of
  /// the gate. Resets a fault of the previous push. Ignored during a weighing.
  void push() noexcept;
  /// Weighs the stylus where it is; DeviceTrialRecord::weighed is the result. Resets a fault. Ends a push; ignored
  /// during a weighing. `placed_X_DS`: a simulated hand holds a simulated stylus there until the device
  /// holds it; in D.
  void weigh(const std::optional<Pose>& placed_X_DS = {}) noexcept;
  bool is_weighing() const noexcept { return weighing_.is_running(); }
  /// Peak force of the push: 0.6 of the continuous force, at most 1 N; 3 N for a device that only displays forces
  /// (rumble).
  double push_n() const noexcept { return push_n_; }

  static constexpr double kPush_s = 1.5;

 private:
  haptics::GateInput sense(const devices::DeviceReading& now, double dt_s) noexcept;
  void ask_push(haptics::GateInput& input) noexcept;
  void ask_weighing(const devices::DeviceReading& now, haptics::GateInput& input) noexcept;
  void move_simulated_hand(double now_s) noexcept;

  devices::HapticDevice& device_;
  const haptics::GateParams gate_;
  const double push_n_;
  haptics::GateState state_;
  std::optional<double> pushing_s_;  ///< Time of the push after the safe start.
  StylusWeighing weighing_;
  std::optional<Pose> placed_X_DS_;  ///< Of a simulated hand, until it lets go.
  bool is_placed_ = false;
  std::optional<Pose> last_X_DS_;
  detail::ReadingAge age_;
  bool is_reset_ = false;
  bool has_refused_ = false;  ///< The device did not take the last wrench.
};

/// Reason of a refused weighing and what to do. `device`: its name, for the message. The refusal must not be kNone.
Error weigh_error(const WeighResult& result, const std::string& device);
/// Sentence with the weight, beside that of the preset, the friction, and remarks on horizontal force and lever.
std::string weigh_text(const WeighResult& result, const stylus::DevicePreset& preset);

}  // namespace trocar::server
