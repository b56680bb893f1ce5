#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "attempt/servers/server_host.h"
#include "core/testing/fake_clock.h"
#include "telemetry/tick_sample.h"

namespace trocar::testing {

/// A haptic server without forces, in a test's own time: it replies to every command, its device is at the pose where
/// it was placed, and the test sets when it ends, stops sending or has a fault.
class ScriptedServer final : public attempt::ServerHost {
 public:
  explicit ScriptedServer(FakeClock& clock, std::string device = "virtual:premium", std::string tool = "needle")
      : clock_(clock), device_(std::move(device)), tool_(std::move(tool)) {
    participation_ = clock_.attach([this] { step(); });
  }

  // Set by the test.
  bool is_silent = false;           ///< No message arrives.
  bool has_no_processor = false;    ///< is_held_up() of its process.
  bool is_device_gone = false;      ///< kReconnect fails.
  bool is_device_fixed = false;     ///< A person holds it: it does not follow targets.
  bool is_fault_permanent = false;  ///< kResetFault does nothing.
  bool has_control = true;
  Status restarts_well;
  std::string refuses_parameters;  ///< The reply to SetParameters; empty: done.
  std::string refuses_scene;
  void end(const std::string& why) { alive_ = fail(why, "trocar-hapticd", "its log"); }
  /// Simulates another process at the endpoint; this program did not start it.
  void come_back() {
    ++session_;
    gate_ = telemetry::GateMode::kOff;
    fault_ = telemetry::GateFault::kNone;
  }
  void set_fault(telemetry::GateFault fault) {
    fault_ = fault;
    gate_ = telemetry::GateMode::kFault;
  }

  // Received commands.
  int restarts = 0, connections = 0, scenes = 0;
  std::vector<link::ServerCommand> commands;
  std::vector<link::SetParameters> parameters;  ///< All received messages.
  std::optional<link::HandTarget> target;
  int count(link::ServerCommand command) const {
    return static_cast<int>(std::count(commands.begin(), commands.end(), command));
  }
  telemetry::GateMode gate() const { return gate_; }
  telemetry::GateFault fault() const { return fault_; }

  // ServerHost.
  const std::string& tool() const noexcept override { return tool_; }
  const std::string& device() const noexcept override { return device_; }
  const std::string& endpoint() const noexcept override { return endpoint_; }
  int pid() const override { return 1000 + restarts; }
  Status check() override { return alive_; }
  bool is_held_up() override { return has_no_processor; }
  Status restart() override {
    ++restarts;
    if (!restarts_well) return restarts_well;
    alive_ = {};
    is_silent = has_no_processor = false;
    come_back();
    return {};
  }
  Result<std::unique_ptr<attempt::ServerConnection>> connect(link::ClientOptions options) override;

 private:
  class Connection;
  void step();
  link::ServerStatus status() const;
  link::Reply answer(const link::Command& command);
  void apply(link::ServerCommand command);

  FakeClock& clock_;
  std::string device_, tool_, endpoint_ = "ipc:///scripted";
  Status alive_;
  Connection* connection_ = nullptr;
  std::uint64_t session_ = 1, tick_ = 0;
  double time_s_ = 100.0;
  telemetry::GateMode gate_ = telemetry::GateMode::kOff;
  telemetry::GateFault fault_ = telemetry::GateFault::kNone;
  std::shared_ptr<const void> participation_;
  Pose X_P_;  ///< Pose of the device's tool.
};

class ScriptedServer::Connection final : public attempt::ServerConnection {
 public:
  explicit Connection(ScriptedServer& server) : server_(server) {}
  ~Connection() override {
    if (server_.connection_ == this) server_.connection_ = nullptr;
  }
  link::ClientView view() const override {
    link::ClientView seen = view_;
    constexpr double kConnected_s = 0.25;
    seen.is_connected = seen.welcome.session != 0 && seen.silent_s <= kConnected_s;
    return seen;
  }
  std::vector<link::NumberedSample> take_samples() override { return std::exchange(samples_, {}); }
  std::optional<telemetry::TickSample> newest() const override { return newest_; }
  std::uint32_t send(decltype(link::Command::what) what) override {
    sent_.push_back({++last_request_, std::move(what)});
    return last_request_;
  }
  std::vector<link::Reply> take_replies() override { return std::exchange(replies_, {}); }
  Result<std::string> ask(decltype(link::Command::what) what, std::chrono::milliseconds) override {
    return server_.answer({++last_request_, std::move(what)}).text;
  }
  void set_target(const link::HandTarget& target) override {
    server_.target = target;
    if (!server_.is_device_fixed) server_.X_P_ = target.X_PN;
  }
  void frame_drawn() override {}

 private:
  friend class ScriptedServer;
  /// A millisecond in which the server's messages arrive, unless it is silent.
  void step(double dt_s, bool is_heard) {
    view_.silent_s = is_heard ? 0.0 : view_.silent_s + dt_s;
    if (!is_heard) return;
    if (view_.welcome.session != server_.session_) {
      for (const link::Command& lost : std::exchange(sent_, {}))
        replies_.push_back({lost.request, false, "the server disconnected before it replied"});
      view_.welcome = {server_.session_, "a scripted server", server_.tool_, server_.has_control, {}};
      view_.welcome.device.name = server_.device_;
      view_.status = {};
      newest_.reset();
      return;
    }
    view_.welcome.has_control = server_.has_control;
    view_.status = server_.status();
    for (const link::Command& command : std::exchange(sent_, {})) replies_.push_back(server_.answer(command));
    newest_.emplace();
    newest_->time_s = server_.time_s_;
    newest_->device_mm = server_.X_P_.p();
    const Eigen::Quaterniond q(server_.X_P_.R());
    newest_->device_rotation_wxyz = {q.w(), q.x(), q.y(), q.z()};
    samples_.push_back({server_.tick_, *newest_, static_cast<std::uint64_t>(server_.scenes)});
  }

  ScriptedServer& server_;
  link::ClientView view_;
  std::vector<link::NumberedSample> samples_;
  std::optional<telemetry::TickSample> newest_;
  std::vector<link::Command> sent_;
  std::vector<link::Reply> replies_;
  std::uint32_t last_request_ = 0;
};

inline Result<std::unique_ptr<attempt::ServerConnection>> ScriptedServer::connect(link::ClientOptions) {
  ++connections;
  auto connection = std::make_unique<Connection>(*this);
  connection_ = connection.get();
  return connection;
}

inline void ScriptedServer::step() {
  constexpr double kStep_s = 0.001;
  time_s_ += kStep_s;
  const bool is_heard = alive_ && !is_silent;
  if (is_heard) ++tick_;
  if (connection_ != nullptr) connection_->step(kStep_s, is_heard);
}

inline link::ServerStatus ScriptedServer::status() const {
  link::ServerStatus status;
  status.server_time_s = time_s_;
  status.gate_mode = gate_;
  status.fault = fault_;
  status.loop.wanted_hz = status.loop.achieved_hz = 1000.0;
  return status;
}

inline link::Reply ScriptedServer::answer(const link::Command& command) {
  link::Reply reply{command.request, true, "done"};
  if (const auto* simple = std::get_if<link::ServerCommand>(&command.what)) {
    apply(*simple);
    const bool is_refused = *simple == link::ServerCommand::kReconnect && is_device_gone;
    if (is_refused) reply = {command.request, false, "no device is connected"};
    return reply;
  }
  const auto* changed = std::get_if<link::SetParameters>(&command.what);
  if (changed != nullptr) parameters.push_back(*changed);
  const std::string& refusal = changed != nullptr ? refuses_parameters : refuses_scene;
  if (!refusal.empty()) return {command.request, false, refusal};
  reply.text = changed != nullptr ? "the scene has changed parameters" : "the scene is loaded";
  reply.scene = static_cast<std::uint64_t>(++scenes);
  return reply;
}

inline void ScriptedServer::apply(link::ServerCommand command) {
  commands.push_back(command);
  const bool has_fault = fault_ != telemetry::GateFault::kNone;
  if (command == link::ServerCommand::kStart && !has_fault) gate_ = telemetry::GateMode::kOn;
  if (command == link::ServerCommand::kStop && !has_fault) gate_ = telemetry::GateMode::kOff;
  if (command == link::ServerCommand::kResetFault && !is_fault_permanent) {
    fault_ = telemetry::GateFault::kNone;
    gate_ = telemetry::GateMode::kOff;
  }
}

}  // namespace trocar::testing
