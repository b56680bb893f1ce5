// Preparation of a haptic server, from the first message to forces that are on.
#include <fmt/format.h>

#include <algorithm>

#include "attempt/servers/detail/sentence.h"
#include "attempt/servers/server_supervisor.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPlaceAgain{20}, kResetAgain{200};
constexpr double kLongestPoll_s = 0.05;  // a longer gap between two polls is a delay of this program
/// A client that disconnected without Goodbye keeps control for so long.
constexpr double kControlTimeout_s = link::kControlLost_s + 1.0;
constexpr double kSagging_mm =
    10.0;  // without forces the hand alone bears the stylus' weight: 0.5 N at 0.6 N/mm, tilted
constexpr double kSettled_mm = 0.5;
constexpr double kSettledAxis = 0.02;    // rad
constexpr double kMostSettling_s = 1.0;  // inside tissue it comes to rest elsewhere

Vec3 axis_of(const telemetry::TickSample& sample) noexcept {
  const auto& [w, x, y, z] = sample.device_rotation_wxyz;
  return Eigen::Quaterniond(w, x, y, z).toRotationMatrix().col(2);
}

double seconds(milliseconds duration) noexcept {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

void ServerSupervisor::prepare(const PreparationRequest& request) {
  request_ = request;
  stalls_left_ = kMostStallsOfStart;
  requested_ = clock_->now();
  request_->place.v_P = request_->place.w_P = Vec3::Zero();
  // A soft hand would let the stylus sag across the needle's channel before the forces are on: they would not start.
  request_->place.is_rigid = true;
}

void ServerSupervisor::place_at(const telemetry::NeedlePlace& needle) {
  if (!request_) return;
  request_->place.X_PN = needle.X_PN;
  request_->place.pressed_mm = std::min(needle.pressed_mm, link::kMostPressed_mm);
}

void ServerSupervisor::enter(ServerState state) {
  state_ = state;
  in_state_s_ = without_control_s_ = 0.0;
  was_placed_ = false;
}

void ServerSupervisor::count_time() {
  const Clock::TimePoint now = clock_->now();
  in_state_s_ += std::min(seconds_between(polled_, now), kLongestPoll_s);
  polled_ = now;
}

bool ServerSupervisor::has_timed_out() const noexcept {
  return in_state_s_ >= seconds(options_.timeout);
}

Status ServerSupervisor::check_time(const char* what, const char* advice) const {
  if (!has_timed_out()) return {};
  return fail(fmt::format("{} within {:.1f} s", what, seconds(options_.timeout)), host_->endpoint(), advice);
}

Status ServerSupervisor::check_silence() const {
  if (client_.silent_s <= seconds(options_.timeout)) return {};
  const bool was_heard = client_.welcome.session != 0;
  const std::string why = client_.refusal.empty() ? "" : ": " + client_.refusal;
  return fail(fmt::format("{} for {:.1f} s{}", was_heard ? "the server has not responded" : "no server has responded",
                          client_.silent_s, why),
              host_->endpoint(),
              was_heard ? "see its log; it can be restarted within --patience"
                        : "start trocar-hapticd there; with keys, each side needs the other's public key");
}

Status ServerSupervisor::step_preparation() {
  switch (state_) {
    case ServerState::kConnecting:
      return step_connecting();
    case ServerState::kIdle:
      if (!request_) return {};
      asked_ = send(request_->scene);
      enter(ServerState::kLoading);
      return {};
    case ServerState::kLoading:
      return step_loading();
    case ServerState::kAdjusting:
      step_adjusting();
      return {};
    case ServerState::kPlacing:
      return step_placing();
    case ServerState::kStarting:
      return step_starting();
    case ServerState::kSettling:
      step_settling();
      return {};
    default:
      return {};
  }
}

Status ServerSupervisor::step_connecting() {
  const bool has_all = client_.is_connected && client_.welcome.session != 0 && client_.status.loop.wanted_hz > 0.0;
  if (!has_all) return {};
  if (!client_.welcome.has_control) return wait_for_control();
  const bool has_fault = client_.status.fault != telemetry::GateFault::kNone;
  const bool may_reset = request_ && (options_.recovery == Recovery::kAll || is_forgivable_stall());
  if (has_fault && may_reset) return reset_fault();
  const bool is_another = session_ != client_.welcome.session;
  session_ = client_.welcome.session;
  take_replies();
  if (is_another) scenes_.clear();
  enter(ServerState::kIdle);
  return {};
}

Status ServerSupervisor::wait_for_control() {
  if (without_control_s_ == 0.0) without_control_s_ = in_state_s_;
  if (in_state_s_ - without_control_s_ < kControlTimeout_s) return {};
  return fail("another client controls this server", host_->endpoint(), "end it, or name another server");
}

Status ServerSupervisor::reset_fault() {
  if (clock_->now() - reset_ > kResetAgain) {
    connection_->send(link::ServerCommand::kStop);  // the forces come on when the tool is at its pose
    connection_->send(link::ServerCommand::kResetFault);
    reset_ = clock_->now();
  }
  return check_time("the fault of the safety gate persists", "look at the server's log");
}

std::vector<link::Reply> ServerSupervisor::take_replies() {
  std::vector<link::Reply> replies = connection_->take_replies();
  for (const link::Reply& reply : replies) scenes_.learn(reply);
  return replies;
}

Result<bool> ServerSupervisor::is_answered() {
  for (const link::Reply& reply : take_replies()) {
    if (reply.request != asked_) continue;
    if (reply.is_done) return true;
    // A command to a server that disconnected was not refused: it is sent again when the server is back.
    const link::ClientView now = connection_->view();
    if (now.is_connected && now.welcome.session == session_)
      return fail(reply.text, host_->endpoint(), "see the log of the server");
    return false;
  }
  return false;
}

Status ServerSupervisor::step_loading() {
  TROCAR_TRY(const bool is_loaded, is_answered());
  if (is_loaded) adjust();
  return {};
}

/// Times of this program's clock become those of the server's, here and in the next one.
std::uint32_t ServerSupervisor::send(link::LoadScene message) {
  message.motion.begins_s += client_.clock_offset_s;
  return connection_->send(message);
}

std::uint32_t ServerSupervisor::send(link::SetParameters message) {
  if (message.motion) message.motion->begins_s += client_.clock_offset_s;
  return connection_->send(message);
}

void ServerSupervisor::adjust() {
  adjusted_ = memory_.message();
  if (adjusted_ == link::SetParameters{}) {
    enter(ServerState::kPlacing);
    return;
  }
  asked_ = send(adjusted_);
  enter(ServerState::kAdjusting);
}

/// Refused parameters are forgotten: the preparation continues without them.
void ServerSupervisor::step_adjusting() {
  const Result<bool> is_taken = is_answered();
  if (!is_taken) {
    memory_ = {};
    messages_.push_back(is_taken.error().what);
  }
  if (!is_taken || *is_taken) enter(ServerState::kPlacing);
}

bool ServerSupervisor::is_near(const telemetry::TickSample& sample, double most_mm) const {
  return (sample.device_mm - request_->place.X_PN.p()).norm() < most_mm;
}

Status ServerSupervisor::step_placing() {
  if (is_start_held_) in_state_s_ = 0.0;
  TROCAR_TRY_STATUS(check_time("the device did not reach the pose of the operator's hand",
                               "scripted operators work only with simulated devices: trocar-hapticd --device virtual"));
  const std::optional<telemetry::TickSample> newest = connection_->newest();
  if (!newest) return {};
  if (has_person()) {
    if (client_.status.fault == telemetry::GateFault::kNone && !is_start_held_) start_forces(nullptr);
    return {};
  }
  link::HandTarget place = request_->place;
  place.server_time_s = newest->time_s;
  if (!is_start_held_ && was_placed_ && newest->time_s != placed_newest_s_ && is_near(*newest, kSagging_mm)) {
    start_forces(&place);
  } else if (clock_->now() - placed_ > kPlaceAgain) {
    place.is_placed = true;
    connection_->set_target(place);
    was_placed_ = true;
    placed_ = clock_->now();
    placed_newest_s_ = newest->time_s;
  }
  return {};
}

void ServerSupervisor::start_forces(const link::HandTarget* place) {
  if (place != nullptr) connection_->set_target(*place);
  asked_ = connection_->send(link::ServerCommand::kStart);
  started_server_s_ = 0.0;
  enter(ServerState::kStarting);
}

Status ServerSupervisor::step_starting() {
  if (started_server_s_ == 0.0) {
    TROCAR_TRY(const bool is_started, is_answered());
    if (is_started) started_server_s_ = client_.status.server_time_s;
  }
  const bool has_later_status = started_server_s_ > 0.0 && client_.status.server_time_s > started_server_s_;
  if (has_later_status && client_.status.gate_mode == telemetry::GateMode::kOn) {
    enter(ServerState::kSettling);
    return {};
  }
  return check_time("the forces did not switch on", "look at the server's log");
}

void ServerSupervisor::step_settling() {
  const std::optional<telemetry::TickSample> newest = connection_->newest();
  const bool is_settled = has_person() || (newest && is_near(*newest, kSettled_mm) &&
                                           (axis_of(*newest) - request_->place.X_PN.R().col(2)).norm() < kSettledAxis);
  if (is_settled || in_state_s_ >= kMostSettling_s) become_on();
}

void ServerSupervisor::become_on() {
  connection_->take_samples();
  last_tick_.reset();
  enter(ServerState::kOn);
  stalls_left_ = 0;
  ++activations_;
  ticked_ = clock_->now();
  banner_.clear();
  if (!interrupted_by_.empty())
    recovery_ =
        fmt::format("{}. The forces are on again and the puncture continues", detail::sentence(interrupted_by_));
  interrupted_by_.clear();
  const link::SetParameters now = memory_.message();  // it may have changed while the forces were being switched on
  if (now != adjusted_) unanswered_[send(now)] = memory_;
}

}  // namespace trocar::attempt
