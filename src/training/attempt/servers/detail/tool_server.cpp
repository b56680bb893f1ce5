#include "attempt/servers/detail/tool_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "attempt/servers/seat_devices.h"
#include "haptics/gate/safety_gate.h"

namespace trocar::attempt {
namespace {

using State = ServerSeat::State;
using namespace std::chrono_literals;

constexpr std::size_t kMostReturns = 6;  ///< Per minute; more mean a problem of the machine. [assumed]
constexpr auto kAskAgain = 1s;           ///< Interval of the checks for a device.
constexpr auto kFresh = 250ms;           ///< Older ticks do not give the pose of the tool.
constexpr auto kAsleep = 500ms;          ///< A silent process that sleeps for this time has failed. [assumed]
constexpr double kMostPatience = 4.0;    ///< Of a busy process: it may be in an endless loop. [assumed]

std::string words_of(const std::string& device) {
  if (device == "spacemouse") return "SpaceMouse";
  if (device.find(':') != std::string::npos) return seat_device_title(device);
  return device.empty() ? "device" : device.substr(0, device.find(':'));
}

std::string sentence(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace

DeviceHold device_hold(const std::string& device_spec) {
  const std::string kind = device_spec.substr(0, device_spec.find(':'));
  if (kind == "virtual" || kind == "mouse") return DeviceHold::kOurHand;
  if (kind == "gamepad" || kind == "spacemouse") return DeviceHold::kPlaced;
  return DeviceHold::kRealHand;
}

ToolServer::ToolServer(ServerHost& host, std::chrono::milliseconds patience, bool has_window, Clock& clock)
    : host_(&host),
      clock_(&clock),
      patience_(patience),
      has_window_(has_window),
      is_real_hand_(device_hold(host.device()) == DeviceHold::kRealHand),
      tool_(host.tool()) {
  connect();
}

void ToolServer::connect() {
  if (seat_) missing_before_ += seat_->ticks_missing();
  seat_.reset();  // sends Goodbye before the next client requests control
  was_on_ = false;
  stalls_ = 0;
  lost_device_.reset();
  before_.clear();
  link::ClientOptions options;
  options.name = "trocar station";
  options.has_window = has_window_;
  Result<std::unique_ptr<ServerConnection>> connection = host_->connect(options);
  if (!connection) {
    give_up(connection.error());
    return;
  }
  seat_.emplace(*std::move(connection), host_->endpoint(), patience_, *clock_);
  if (!request_) return;
  request_->parameters = parameters();
  seat_->hold(*request_);
}

void ToolServer::hold(const SeatRequest& request) {
  request_ = request;
  request_->is_in_real_hand = is_real_hand_;
  request_->resets_fault = true;
  request_->parameters = parameters();
  if (seat_) seat_->hold(*request_);
}

void ToolServer::place_at(const Pose& X_PN) {
  if (request_) request_->place.X_PN = X_PN;
  if (seat_) seat_->place_at(X_PN);
}

std::string ToolServer::give_up(Error why) {
  has_given_up_ = true;
  failure_ = std::move(why);
  return banner_ = failure_.text();
}

std::string ToolServer::bring_back(const std::string& what, bool is_new_process) {
  const auto now = clock_->now();
  while (!returns_.empty() && now - returns_.front() > 60s) returns_.pop_front();
  returns_.push_back(now);
  if (returns_.size() > kMostReturns) {
    return give_up(
        {fmt::format("The {} server ends repeatedly: {}. Resume to try again, or end the attempt.", tool_, what),
         {},
         {}});
  }
  was_on_ = false;
  interrupted_by_ = is_new_process ? what + " and was restarted" : what;
  banner_ = is_new_process ? fmt::format("{}. It is being restarted; the forces return with the {} at its last pose",
                                         sentence(what), tool_)
                           : fmt::format("{}. The forces return with the {} at its last pose", sentence(what), tool_);
  // Starting a process takes time: the banner must be visible before.
  is_restart_due_ = is_new_process;
  return is_new_process ? banner_ : seat_again(false);
}

std::string ToolServer::seat_again(bool is_new_process) {
  is_restart_due_ = false;
  ++restarts_;
  if (is_new_process) {
    if (const Status started = host_->restart(); !started) {
      return give_up(started.error());
    }
  }
  connect();
  return is_new_process ? std::string() : banner_;
}

bool ToolServer::is_device_lost() const {
  const std::string& fault = seat_->view().status.fault;
  return seat_->view().is_connected && (fault == to_string(telemetry::GateFault::kDeviceLost) ||
                                        fault == to_string(telemetry::GateFault::kDeviceSilent));
}

/// Until it is connected again; forces stay off meanwhile, because the fault is latched.
std::string ToolServer::open_device_again() {
  LostDevice& lost = *lost_device_;
  const auto now = clock_->now();
  for (const link::Reply& reply : seat_->take_replies()) {
    if (reply.request != lost.asked) continue;
    if (reply.is_done) return bring_back(fmt::format("the {} is connected again", device_words()), false);
    lost.asked.reset();
    lost.refused = now;
    if (!is_real_hand_) continue;
    waits_for_resume_ = true;
    banner_ = reply.text + "; resume to try again";
  }
  if (!waits_for_resume_ && !lost.asked && now - lost.refused > kAskAgain)
    lost.asked = seat_->send(link::ServerCommand::kReconnect);
  return {};
}

std::string ToolServer::look() {
  if (has_given_up_ || waits_for_resume_ || !seat_) return {};
  if (is_stopped_ && !was_on_) return {};  // holding a scene would switch the forces on
  if (is_restart_due_) return seat_again(true);
  if (const Status alive = host_->check(); !alive) {
    if (!was_ever_heard_) {
      // It cannot start: a missing device, a wrong name.
      return give_up(alive.error());
    }
    if (!is_stopped_) return bring_back(alive.error().what, true);
    was_on_ = false;
    banner_ = alive.error().what + "; it is restarted when you resume";
    return banner_;
  }
  const Result<State> state = seat_->look();
  was_ever_heard_ = was_ever_heard_ || seat_->view().welcome.session != 0;
  if (seat_->view().is_connected || host_->is_held_up()) held_up_ = clock_->now();
  if (std::optional<std::string> refusal = seat_->take_refusal()) {
    settings_ = {};
    messages_.push_back(*std::move(refusal));
  }
  if (!state) return cannot_go_on(state.error());
  if (*state == State::kOn && !was_on_) {
    was_on_ = true;
    ++seatings_;
    ticked_ = clock_->now();
    banner_.clear();
    if (!interrupted_by_.empty())
      recovery_ = fmt::format("{}. The forces are on again and the puncture continues", sentence(interrupted_by_));
    interrupted_by_.clear();
    const link::SetParameters now = parameters();  // set while the forces were switched on
    if (now.settings != seat_->adjusted().settings) before_[seat_->send(now)] = settings_;
  }
  if (was_on_ && *state != State::kOn) return note_interruption();
  if (!was_on_) return {};
  if (!seat_->view().is_connected) {
    banner_ = fmt::format("The {} server does not respond. Waiting for it", tool_);
  } else if (clock_->now() - ticked_ > kFresh) {
    banner_ = fmt::format("No data from the {}: this machine is too busy", tool_);
  } else {
    banner_.clear();
  }
  note_replies();
  return {};
}

void ToolServer::note_replies() {
  for (const link::Reply& reply : seat_->take_replies()) {
    const auto before = before_.find(reply.request);
    if (before == before_.end()) continue;
    if (!reply.is_done) settings_ = before->second;  // a message is applied completely or not at all
    messages_.push_back(reply.text);
    before_.erase(before);
    seat_->adjust(parameters());
  }
}

/// The server reconnected, or stalled; it holds the tool at its last pose.
std::string ToolServer::note_interruption() {
  was_on_ = false;
  before_.clear();
  const bool is_stall = seat_->stalls() > stalls_;
  stalls_ = seat_->stalls();
  const char* const what = is_stall ? "stopped because this machine is too busy" : "was unavailable";
  interrupted_by_ = fmt::format("the {} server {}", tool_, what);
  if (is_stopped_) return banner_ = fmt::format("The {} server {}; resume when you are ready", tool_, what);
  return banner_ = fmt::format("The {} server {}. The forces return with the {} at its last pose", tool_, what, tool_);
}

/// True if a silent server only lacks processor time.
bool ToolServer::is_slow() const {
  return clock_->now() - held_up_ < kAsleep &&
         seat_->view().silent_s < kMostPatience * std::chrono::duration<double>(patience_).count();
}

std::string ToolServer::cannot_go_on(const Error& why) {
  const bool is_heard = seat_->view().is_connected;
  if (lost_device_ && is_heard) return open_device_again();
  if (is_device_lost() && !is_stopped_ && !is_real_hand_) {
    was_on_ = false;
    lost_device_.emplace();
    return banner_ = fmt::format(
               "The {} is disconnected. Plug it in to continue the puncture at the present pose, or end the attempt.",
               device_words());
  }
  if (is_stopped_ || (is_real_hand_ && is_heard)) {
    was_on_ = false;
    waits_for_resume_ = !is_stopped_;
    if (is_device_lost()) {
      const bool is_gone = seat_->view().status.fault == to_string(telemetry::GateFault::kDeviceLost);
      return banner_ = fmt::format("{}, which moves the {}, {}, then resume the forces (Space).", device_words(),
                                   tool_ == "probe" ? "transducer" : tool_,
                                   is_gone ? "is disconnected. Plug it in again" : "sends no data. Check its cable");
    }
    return banner_ = why.what + "; resume when you are ready";
  }
  if (!is_heard && is_slow()) {
    banner_ = fmt::format("The {} server does not respond because it gets no processor time. Waiting for it", tool_);
    return {};
  }
  // A server that responds has a fault, which the next connection resets; one that does not respond is ended.
  return bring_back(why.what, !is_heard);
}

bool ToolServer::is_on() const noexcept {
  return seat_ && was_on_ && !has_given_up_ && seat_->state() == State::kOn && seat_->view().is_connected &&
         clock_->now() - ticked_ < kFresh;
}

std::string ToolServer::doing() const {
  if (!seat_) return fmt::format("starting the server of the {}", tool_);
  switch (seat_->state()) {
    case State::kConnecting:
    case State::kReady:
      return fmt::format("starting the server of the {}", tool_);
    case State::kLoading:
      return fmt::format("loading the patient for the {}", tool_);
    case State::kPlacing:
    case State::kStarting:
    case State::kSettling:
    case State::kOn:
      break;
  }
  return fmt::format("switching on the forces of the {}", tool_);
}

std::vector<link::NumberedSample> ToolServer::take_samples() {
  if (!seat_ || !was_on_) return {};
  std::vector<link::NumberedSample> samples = seat_->take_samples();
  if (!samples.empty()) ticked_ = clock_->now();
  return samples;
}

void ToolServer::set_hand(const link::HandTarget& target) {
  if (is_on()) seat_->set_hand(target);
}

link::SetParameters ToolServer::parameters() const {
  std::vector<std::string> all = settings_.tissues;
  for (const auto& [key, setting] : settings_.other) all.push_back(setting);
  return {std::move(all)};
}

void ToolServer::set_parameters(const std::vector<std::string>& settings) {
  const Settings before = settings_;
  std::vector<std::string> tissues;
  for (const std::string& setting : settings) {
    const std::string key = setting.substr(0, setting.find('='));
    const bool is_tissues = key != "force_model" && key != "bending" && !key.starts_with("coupling.");
    if (is_tissues) {
      tissues.push_back(setting);
    } else {
      settings_.other[key] = setting;
    }
  }
  if (!tissues.empty() || settings.empty()) settings_.tissues = std::move(tissues);
  if (seat_) seat_->adjust(parameters());
  if (is_on()) before_[seat_->send(link::SetParameters{settings})] = before;
}

std::vector<std::string> ToolServer::take_messages() {
  return std::exchange(messages_, {});
}

void ToolServer::stop_forces() {
  is_stopped_ = true;
  if (seat_) seat_->send(link::ServerCommand::kStop);
}

void ToolServer::resume_forces() {
  is_stopped_ = false;
  waits_for_resume_ = false;
  if (has_given_up_) returns_.clear();
  const Status alive = host_->check();
  const bool is_alive = alive.has_value();
  if (is_on() && is_alive) {
    seat_->send(link::ServerCommand::kStart);
    return;
  }
  has_given_up_ = false;
  if (is_alive && seat_ && is_device_lost()) {
    lost_device_.emplace();  // the next look() starts it again
    return;
  }
  const bool is_heard = seat_ && seat_->view().is_connected;
  const std::string what =
      is_alive ? fmt::format("the server of the {} {}", tool_, is_heard ? "is resumed" : "does not answer")
               : alive.error().what;
  bring_back(what, !is_alive || !is_heard);
}

void ToolServer::frame_drawn() {
  if (seat_) seat_->frame_drawn();
}

void ToolServer::end() {
  if (seat_) seat_->stop();
}

std::string ToolServer::device_words() const {
  return words_of(client().welcome.device.name);
}

const link::ClientView& ToolServer::client() const {
  static const link::ClientView kNone;
  return seat_ ? seat_->view() : kNone;
}

ServerView ToolServer::view() const {
  const link::ClientView& client_view = client();
  const link::ServerStatus& status = client_view.status;
  ServerView view;
  view.tool = tool_;
  view.pid = host_->pid();
  view.is_connected = client_view.is_connected;
  view.is_on = is_on() && !is_stopped_;
  view.device = client_view.welcome.device.name;
  view.rate_hz = status.loop.achieved_hz;
  view.wanted_hz = status.loop.wanted_hz;
  view.p99_us = status.loop.lateness.p99_us;
  view.ticks_missing = missing_before_ + (seat_ ? seat_->ticks_missing() : 0);
  view.gate = status.gate_mode;
  view.fault = status.fault == "none" ? std::string() : status.fault;
  view.grant = status.grant;
  view.warning = status.warning;
  view.restarts = restarts_;
  view.waits_for_resume = waits_for_resume_ || has_given_up_;
  return view;
}

ServerFigures ToolServer::figures() const {
  ServerFigures figures;
  if (seat_) figures = seat_->figures();
  figures.tool = tool_;
  figures.returns = restarts_ + (seat_ ? seat_->returns() + seat_->stalls() : 0);
  return figures;
}

}  // namespace trocar::attempt
