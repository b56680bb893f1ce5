#include "attempt/servers/server_supervisor.h"

#include <fmt/format.h>

#include <algorithm>

#include "attempt/servers/detail/sentence.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMostReturns = 6;  ///< Per minute; more often, the machine has a problem. [assumed]
constexpr auto kReopenAgain = 1s;        ///< Between two attempts to open a device.
constexpr auto kFresh = 250ms;           ///< After that, the pose of a tool is unknown.
constexpr auto kAsleep = 500ms;          ///< A silent process that sleeps for so long does not work any more. [assumed]
constexpr double kMostTimeouts = 4.0;    ///< Of a busy process: it may be in an endless loop. [assumed]

}  // namespace

const char* to_string(ServerState state) noexcept {
  switch (state) {
    case ServerState::kConnecting:
      return "connecting";
    case ServerState::kIdle:
      return "idle";
    case ServerState::kLoading:
      return "loading";
    case ServerState::kAdjusting:
      return "adjusting";
    case ServerState::kPlacing:
      return "placing";
    case ServerState::kStarting:
      return "starting";
    case ServerState::kSettling:
      return "settling";
    case ServerState::kOn:
      return "on";
    case ServerState::kDeviceLost:
      return "device lost";
    case ServerState::kRestartDue:
      return "restart due";
    case ServerState::kStopped:
      return "stopped";
    case ServerState::kNeedsResume:
      return "needs resume";
    case ServerState::kFailed:
      return "failed";
  }
  return "?";
}

ServerSupervisor::ServerSupervisor(ServerHost& host, SupervisionOptions options, Clock& clock)
    : host_(&host),
      options_(std::move(options)),
      clock_(&clock),
      control_(host.device().empty() ? DeviceControl::kTargets : device_control(host.device())) {
  connect();
}

const std::string& ServerSupervisor::tool() const noexcept {
  return host_->tool().empty() ? client_.welcome.tool : host_->tool();
}

void ServerSupervisor::connect() {
  connection_.reset();  // says goodbye before the next one requests control
  session_ = 0;
  scenes_.clear();
  last_tick_.reset();
  unanswered_.clear();
  client_ = {};
  polled_ = clock_->now();
  enter(ServerState::kConnecting);
  link::ClientOptions options;
  options.name = options_.client_name;
  options.has_window = options_.has_window;
  Result<std::unique_ptr<ServerConnection>> connection = host_->connect(options);
  if (connection) {
    connection_ = *std::move(connection);
  } else {
    give_up(connection.error());
  }
}

std::string ServerSupervisor::give_up(Error why) {
  enter(ServerState::kFailed);
  failure_ = std::move(why);
  return banner_ = failure_.text();
}

bool ServerSupervisor::is_waiting() const noexcept {
  return state_ == ServerState::kFailed || state_ == ServerState::kNeedsResume || state_ == ServerState::kStopped;
}

std::string ServerSupervisor::poll() {
  if (is_waiting()) return {};
  if (state_ == ServerState::kRestartDue) return restart();
  if (const Status alive = host_->check(); !alive) return note_end(alive.error());
  client_ = connection_->view();
  was_heard_ = was_heard_ || client_.welcome.session != 0;
  if (client_.is_connected || host_->is_held_up()) held_up_ = clock_->now();
  count_time();
  return poll_connection();
}

std::string ServerSupervisor::poll_connection() {
  if (const Status heard = check_silence(); !heard) return fail_with(heard.error());
  if (state_ != ServerState::kConnecting && client_.welcome.session != session_) {
    if (session_ != 0) ++reconnects_;
    const bool was_on = state_ == ServerState::kOn;
    enter(ServerState::kConnecting);
    if (was_on) return note_interruption("was unavailable");
  }
  if (state_ == ServerState::kDeviceLost) return poll_lost_device();
  if (const Status stepped = step_preparation(); !stepped) return fail_with(stepped.error());
  const telemetry::GateFault fault = client_.status.fault;
  const bool has_fault = fault != telemetry::GateFault::kNone;
  if (state_ != ServerState::kConnecting && client_.is_connected && has_fault) {
    if (!is_forgivable_stall())
      return fail_with({fmt::format("the safety gate has latched a fault: {}", to_string(fault)), host_->endpoint(),
                        "see the server's flight record for the cause; restart the server"});
    ++stalls_;
    if (!is_early()) stalls_left_ = std::max(0, stalls_left_ - 1);
    const bool was_on = state_ == ServerState::kOn;
    enter(ServerState::kConnecting);
    if (was_on) return note_interruption("stopped because this machine is too busy");
  }
  if (state_ == ServerState::kOn) poll_on();
  return {};
}

/// The process has ended.
std::string ServerSupervisor::note_end(const Error& why) {
  // Without a single message it cannot start at all: a missing device, a wrong name.
  if (!was_heard_ || options_.recovery == Recovery::kReturnsOnly) return give_up(why);
  if (!is_stopped_) return bring_back(why.what, true);
  enter(ServerState::kStopped);
  return banner_ = why.what + "; it is restarted when you resume";
}

/// The server reconnected, or its loop stalled, while the forces were on. It is prepared again.
std::string ServerSupervisor::note_interruption(const char* what) {
  unanswered_.clear();
  interrupted_by_ = fmt::format("the {} server {}", tool(), what);
  if (!is_stopped_) {
    return banner_ =
               fmt::format("The {} server {}. The forces return with the {} at its last pose", tool(), what, tool());
  }
  enter(ServerState::kStopped);
  return banner_ = fmt::format("The {} server {}; resume when you are ready", tool(), what);
}

/// The motors of a device in a person's hand are not switched on again without the person, who still waits for them
/// until they were fully on.
bool ServerSupervisor::is_forgivable_stall() const {
  const telemetry::GateFault fault = client_.status.fault;
  const bool is_stall = fault == telemetry::GateFault::kLoopStalled || fault == telemetry::GateFault::kLoopSlow;
  if (!request_) return false;
  if (!has_person()) return is_stall;
  return (stalls_left_ > 0 || is_early()) && !is_stopped_ && (is_stall || fault == telemetry::GateFault::kDeviceSilent);
}

bool ServerSupervisor::is_early() const {
  constexpr auto kLongestPreparation = 30s;
  return state_ < ServerState::kStarting && clock_->now() - requested_ < kLongestPreparation;
}

bool ServerSupervisor::is_loading() const noexcept {
  return state_ < ServerState::kPlacing || state_ == ServerState::kRestartDue;
}

bool ServerSupervisor::is_device_lost() const {
  const telemetry::GateFault fault = client_.status.fault;
  return client_.is_connected &&
         (fault == telemetry::GateFault::kDeviceLost || fault == telemetry::GateFault::kDeviceSilent);
}

/// Whether a silent server only waits for a processor.
bool ServerSupervisor::is_slow() const {
  return clock_->now() - held_up_ < kAsleep &&
         client_.silent_s < kMostTimeouts * std::chrono::duration<double>(options_.timeout).count();
}

std::string ServerSupervisor::fail_with(const Error& why) {
  if (options_.recovery == Recovery::kReturnsOnly) return give_up(why);
  const bool is_heard = client_.is_connected;
  if (is_device_lost() && !is_stopped_ && !has_person()) {
    enter(ServerState::kDeviceLost);
    reopening_ = {};
    return banner_ = fmt::format(
               "The {} is disconnected. Plug it in to continue the puncture at the present pose, or end the attempt.",
               device_words(client_.welcome.device.name));
  }
  if (is_stopped_ || (has_person() && is_heard)) return await_resume(why);
  if (!is_heard && is_slow()) {
    banner_ = fmt::format("The {} server does not respond because it gets no processor time. Waiting for it", tool());
    return {};
  }
  // A server that responds has a fault, which the next connection resets; one that does not respond is ended.
  return bring_back(why.what, !is_heard);
}

std::string ServerSupervisor::await_resume(const Error& why) {
  enter(is_stopped_ ? ServerState::kStopped : ServerState::kNeedsResume);
  if (!is_device_lost()) return banner_ = why.what + "; resume when you are ready";
  const bool is_gone = client_.status.fault == telemetry::GateFault::kDeviceLost;
  return banner_ = fmt::format("{}, which moves the {}, {}, then resume the forces (Space).",
                               device_words(client_.welcome.device.name), tool() == "probe" ? "transducer" : tool(),
                               is_gone ? "is disconnected. Plug it in again" : "sends no data. Check its cable");
}

std::string ServerSupervisor::bring_back(const std::string& what, bool is_new_process) {
  const Clock::TimePoint now = clock_->now();
  while (!returns_.empty() && now - returns_.front() > 60s) returns_.pop_front();
  returns_.push_back(now);
  if (returns_.size() > kMostReturns) {
    return give_up(
        {fmt::format("The {} server ends repeatedly: {}. Resume to try again, or end the attempt.", tool(), what),
         {},
         {}});
  }
  if (is_new_process) {
    interrupted_by_ = what + " and was restarted";
    enter(ServerState::kRestartDue);
    return banner_ = fmt::format("{}. It is being restarted; the forces return with the {} at its last pose",
                                 detail::sentence(what), tool());
  }
  interrupted_by_ = what;
  banner_ = fmt::format("{}. The forces return with the {} at its last pose", detail::sentence(what), tool());
  ++restarts_;
  connect();
  return banner_;
}

std::string ServerSupervisor::restart() {
  ++restarts_;
  if (const Status started = host_->restart(); !started) return give_up(started.error());
  connect();
  return {};
}

/// Until the device is there again; the forces stay off meanwhile, because the fault is latched.
std::string ServerSupervisor::poll_lost_device() {
  if (!client_.is_connected) return {};
  if (!is_device_lost()) {
    enter(ServerState::kConnecting);
    return {};
  }
  const std::string device = device_words(client_.welcome.device.name);
  for (const link::Reply& reply : take_replies()) {
    if (reply.request != reopening_.asked) continue;
    if (reply.is_done) return bring_back(fmt::format("the {} is connected again", device), false);
    reopening_ = {std::nullopt, clock_->now()};
    if (!has_person()) continue;
    enter(ServerState::kNeedsResume);
    banner_ = reply.text + "; resume to try again";
    return {};
  }
  const bool is_due = !reopening_.asked && clock_->now() - reopening_.refused > kReopenAgain;
  if (is_due) reopening_.asked = connection_->send(link::ServerCommand::kReconnect);
  return {};
}

void ServerSupervisor::poll_on() {
  if (!client_.is_connected) {
    banner_ = fmt::format("The {} server does not respond. Waiting for it", tool());
  } else if (clock_->now() - ticked_ > kFresh) {
    banner_ = fmt::format("No data from the {}: this machine is too busy", tool());
  } else {
    banner_.clear();
  }
  take_on_replies();
}

void ServerSupervisor::take_on_replies() {
  for (const link::Reply& reply : take_replies()) {
    const auto before = unanswered_.find(reply.request);
    if (before == unanswered_.end()) continue;
    if (!reply.is_done) memory_ = before->second;  // a message is applied completely or not at all
    messages_.push_back(reply.text);
    unanswered_.erase(before);
  }
}

bool ServerSupervisor::is_fresh() const noexcept {
  return state_ == ServerState::kOn && client_.is_connected && clock_->now() - ticked_ < kFresh;
}

std::string ServerSupervisor::activity() const {
  switch (state_) {
    case ServerState::kLoading:
    case ServerState::kAdjusting:
      return fmt::format("loading the patient for the {}", tool());
    case ServerState::kPlacing:
    case ServerState::kStarting:
    case ServerState::kSettling:
    case ServerState::kOn:
      return fmt::format("switching on the forces of the {}", tool());
    default:
      return fmt::format("starting the server of the {}", tool());
  }
}

std::vector<link::NumberedSample> ServerSupervisor::take_samples() {
  if (state_ != ServerState::kOn) return {};
  std::vector<link::NumberedSample> samples = connection_->take_samples();
  if (connection_->view().welcome.session != session_) {
    // Ticks of the server that came back may be among them: ours continue without a gap.
    std::uint64_t next = last_tick_ ? *last_tick_ + 1 : 0;
    const auto end = std::find_if(samples.begin(), samples.end(),
                                  [&next](const link::NumberedSample& sample) { return sample.tick != next++; });
    samples.erase(end, samples.end());
  }
  for (const link::NumberedSample& sample : samples) {
    if (last_tick_ && sample.tick > *last_tick_) missing_ += sample.tick - *last_tick_ - 1;
    last_tick_ = sample.tick;
  }
  if (!samples.empty()) ticked_ = clock_->now();
  return samples;
}

void ServerSupervisor::set_target(const link::HandTarget& target) {
  if (is_fresh()) connection_->set_target(target);
}

void ServerSupervisor::set_parameters(const link::SetParameters& message) {
  const ParameterMemory before = memory_;
  memory_.apply(message);
  if (is_fresh()) unanswered_[send(message)] = before;
}

void ServerSupervisor::stop_forces() {
  is_stopped_ = true;
  if (connection_) connection_->send(link::ServerCommand::kStop);
  const bool goes_on = state_ == ServerState::kOn || is_waiting();
  if (!goes_on) enter(ServerState::kStopped);  // its preparation would switch the forces on
}

void ServerSupervisor::resume_forces() {
  is_stopped_ = false;
  stalls_left_ = is_fresh() ? 0 : kMostStallsOfStart;
  requested_ = clock_->now();
  if (state_ == ServerState::kFailed) returns_.clear();
  const Status alive = host_->check();
  if (is_fresh() && alive) {
    connection_->send(link::ServerCommand::kStart);
    return;
  }
  if (alive && connection_ && is_device_lost()) {
    enter(ServerState::kDeviceLost);
    reopening_ = {};
    return;
  }
  const bool is_heard = connection_ && client_.is_connected;
  const std::string what =
      alive ? fmt::format("the server of the {} {}", tool(), is_heard ? "is resumed" : "does not answer")
            : alive.error().what;
  bring_back(what, !alive || !is_heard);
}

void ServerSupervisor::frame_drawn() {
  if (connection_) connection_->frame_drawn();
}

void ServerSupervisor::end() {
  constexpr std::chrono::milliseconds kTimeout{500};
  if (!connection_) return;
  // Without control, the forces are those of another client.
  if (client_.is_connected && client_.welcome.has_control)
    static_cast<void>(connection_->ask(link::ServerCommand::kStop, kTimeout));
  client_ = connection_->view();
}

ServerView ServerSupervisor::view() const {
  const link::ServerStatus& status = client_.status;
  ServerView view;
  view.tool = tool();
  view.pid = host_->pid();
  view.is_connected = client_.is_connected;
  view.is_on = is_fresh() && !is_stopped_;
  view.device = client_.welcome.device.name;
  view.rate_hz = status.loop.achieved_hz;
  view.wanted_hz = status.loop.wanted_hz;
  view.p99_us = status.loop.lateness.p99_us;
  view.ticks_missing = missing_;
  view.gate = status.gate_mode;
  view.fault = status.fault;
  view.grant = status.grant;
  view.warning = status.warning;
  view.restarts = restarts_;
  view.waits_for_resume = state_ == ServerState::kNeedsResume || state_ == ServerState::kFailed;
  return view;
}

ServerFigures ServerSupervisor::figures() const {
  ServerFigures figures;
  figures.tool = tool();
  figures.endpoint = host_->endpoint();
  figures.server = client_.welcome.server;
  figures.device = client_.welcome.device.name;
  figures.grant = client_.status.grant;
  figures.loop = client_.status.loop;
  figures.ticks_received = client_.ticks_received;
  figures.ticks_missing = client_.ticks_missing;
  figures.returns = restarts_ + reconnects_ + stalls_;
  return figures;
}

}  // namespace trocar::attempt
