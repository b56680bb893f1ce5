#include "attempt/servers/server_seat.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "haptics/gate/safety_gate.h"

namespace trocar::attempt {
namespace {

using State = ServerSeat::State;
using std::chrono::milliseconds;

constexpr milliseconds kPlaceAgain{20}, kResetAgain{200};
constexpr double kLongestLook_s = 0.05;  // a longer gap between two calls is caused by this program itself
/// A client that disconnects without Goodbye keeps control for this time.
constexpr double kControlPatience_s = link::kControlLost_s + 1.0;
constexpr double kSagging_mm =
    10.0;  // without forces only the hand holds the stylus' weight: 0.5 N at 0.6 N/mm, tilted
constexpr double kSettled_mm = 0.5;
constexpr double kSettledAxis = 0.02;    // rad
constexpr double kMostSettling_s = 1.0;  // inside tissue it comes to rest at another position

Vec3 axis_of(const telemetry::TickSample& sample) noexcept {
  const auto& [w, x, y, z] = sample.device_rotation_wxyz;
  return Eigen::Quaterniond(w, x, y, z).toRotationMatrix().col(2);
}

bool has_fault(const link::ServerStatus& status) {
  return !status.fault.empty() && status.fault != to_string(telemetry::GateFault::kNone);
}

}  // namespace

ServerSeat::ServerSeat(std::unique_ptr<ServerConnection> connection, std::string endpoint, milliseconds patience,
                       Clock& clock)
    : connection_(std::move(connection)),
      clock_(&clock),
      endpoint_(std::move(endpoint)),
      patience_(patience),
      looked_(clock.now()) {}

void ServerSeat::hold(const SeatRequest& request) {
  request_ = request;
  request_->place.v_P = request_->place.w_P = Vec3::Zero();
  // With a soft hand the stylus would sag across the needle's channel before the forces are on, and they would not
  // switch on.
  request_->place.is_rigid = true;
}

void ServerSeat::place_at(const Pose& X_PN) {
  if (request_) request_->place.X_PN = X_PN;
}

void ServerSeat::adjust(const link::SetParameters& parameters) {
  if (request_) request_->parameters = parameters;
}

std::vector<link::Reply> ServerSeat::take_replies() {
  std::vector<link::Reply> replies = connection_->take_replies();
  for (const link::Reply& reply : replies) scenes_.learn(reply);
  return replies;
}

void ServerSeat::enter(State state) {
  state_ = state;
  is_adjusting_ = false;
  in_state_s_ = without_control_s_ = 0.0;
  was_placed_ = false;
}

void ServerSeat::count_time() {
  const Clock::TimePoint now = clock_->now();
  in_state_s_ += std::min(std::chrono::duration<double>(now - looked_).count(), kLongestLook_s);
  looked_ = now;
}

Status ServerSeat::check_time(const char* what, const char* advice) const {
  if (in_state_s_ < std::chrono::duration<double>(patience_).count()) return {};
  return fail(fmt::format("{} within {:.1f} s", what, std::chrono::duration<double>(patience_).count()), endpoint_,
              advice);
}

Result<State> ServerSeat::look() {
  view_ = connection_->view();
  count_time();
  if (view_.silent_s > std::chrono::duration<double>(patience_).count()) {
    const bool was_heard = view_.welcome.session != 0;
    const std::string why = view_.refusal.empty() ? "" : ": " + view_.refusal;
    return fail(fmt::format("{} for {:.1f} s{}", was_heard ? "the server has not responded" : "no server has responded",
                            view_.silent_s, why),
                endpoint_,
                was_heard ? "see its log; it can be restarted within --patience"
                          : "start trocar-hapticd there; with keys, each side needs the other's public key");
  }
  if (state_ != State::kConnecting && view_.welcome.session != session_) {
    if (session_ != 0) ++returns_;
    enter(State::kConnecting);
  }
  switch (state_) {
    case State::kConnecting:
      TROCAR_TRY_STATUS(connecting());
      break;
    case State::kReady:
      if (request_) {
        asked_ = connection_->send(request_->scene);
        enter(State::kLoading);
      }
      break;
    case State::kLoading:
      TROCAR_TRY_STATUS(loading_scene());
      break;
    case State::kPlacing:
      TROCAR_TRY_STATUS(placing());
      break;
    case State::kStarting:
      TROCAR_TRY_STATUS(starting());
      break;
    case State::kSettling:
      settling();
      break;
    case State::kOn:
      break;
  }
  const bool is_ours = state_ != State::kConnecting && view_.is_connected;
  if (is_ours && is_stall_to_forgive()) {
    ++stalls_;
    enter(State::kConnecting);
  } else if (is_ours && has_fault(view_.status)) {
    return fail(fmt::format("the safety gate has latched a fault: {}", view_.status.fault), endpoint_,
                "see the server's flight record for the cause; restart the server");
  }
  return state_;
}

/// The motors of a device in a person's hand are not switched on again without confirmation.
bool ServerSeat::is_stall_to_forgive() const {
  const std::string& fault = view_.status.fault;
  const bool is_stall =
      fault == to_string(telemetry::GateFault::kLoopStalled) || fault == to_string(telemetry::GateFault::kLoopSlow);
  return request_ && !request_->is_in_real_hand && is_stall;
}

Status ServerSeat::wait_for_control() {
  if (without_control_s_ == 0.0) without_control_s_ = in_state_s_;
  if (in_state_s_ - without_control_s_ < kControlPatience_s) return {};
  return fail("another client controls this server", endpoint_, "end it, or name another server");
}

Status ServerSeat::reset_fault() {
  if (clock_->now() - reset_ > kResetAgain) {
    connection_->send(link::ServerCommand::kStop);  // forces come on when the tool is in its place
    connection_->send(link::ServerCommand::kResetFault);
    reset_ = clock_->now();
  }
  return check_time("the fault of the safety gate persists", "look at the server's log");
}

Status ServerSeat::connecting() {
  const bool has_all = view_.is_connected && view_.welcome.session != 0 && view_.status.loop.wanted_hz > 0.0;
  if (!has_all) return {};
  if (!view_.welcome.has_control) return wait_for_control();
  const bool is_forgiven = request_ && (request_->resets_fault || is_stall_to_forgive());
  if (has_fault(view_.status) && is_forgiven) return reset_fault();
  const bool is_another = session_ != view_.welcome.session;
  session_ = view_.welcome.session;
  take_replies();
  if (is_another) scenes_.clear();
  enter(State::kReady);
  return {};
}

Result<bool> ServerSeat::is_answered() {
  for (const link::Reply& reply : take_replies()) {
    if (reply.request != asked_) continue;
    if (reply.is_done) return true;
    // A command that found the server gone is no refusal: when it is back it will be asked again.
    const link::ClientView now = connection_->view();
    if (now.is_connected && now.welcome.session == session_)
      return fail(reply.text, endpoint_, "see the log of the server");
    return false;
  }
  return false;
}

Status ServerSeat::loading_scene() {
  if (is_adjusting_) {
    const Result<bool> is_taken = is_answered();
    if (!is_taken) {
      refusal_ = is_taken.error().what;
      request_->parameters = {};
    }
    if (!is_taken || *is_taken) enter(State::kPlacing);
    return {};
  }
  TROCAR_TRY(const bool is_loaded, is_answered());
  if (is_loaded) load_parameters();
  return {};
}

void ServerSeat::load_parameters() {
  adjusted_ = request_->parameters;
  if (adjusted_.settings.empty() && adjusted_.tissues_toml.empty()) {
    enter(State::kPlacing);
    return;
  }
  asked_ = connection_->send(adjusted_);
  is_adjusting_ = true;
}

bool ServerSeat::is_near(const telemetry::TickSample& sample, double most_mm) const {
  return (sample.device_mm - request_->place.X_PN.p()).norm() < most_mm;
}

Status ServerSeat::placing() {
  TROCAR_TRY_STATUS(check_time("the device did not reach the pose of the operator's hand",
                               "scripted operators work only with simulated devices: trocar-hapticd --device virtual"));
  const std::optional<telemetry::TickSample> newest = connection_->newest();
  if (!newest) return {};
  link::HandTarget place = request_->place;
  place.server_time_s = newest->time_s;
  if (request_->is_in_real_hand) {
    asked_ = connection_->send(link::ServerCommand::kStart);
    started_server_s_ = 0.0;
    enter(State::kStarting);
    return {};
  }
  if (was_placed_ && newest->time_s != placed_newest_s_ && is_near(*newest, kSagging_mm)) {
    connection_->set_target(place);
    asked_ = connection_->send(link::ServerCommand::kStart);
    started_server_s_ = 0.0;
    enter(State::kStarting);
  } else if (clock_->now() - placed_ > kPlaceAgain) {
    place.is_placed = true;
    connection_->set_target(place);
    was_placed_ = true;
    placed_ = clock_->now();
    placed_newest_s_ = newest->time_s;
  }
  return {};
}

Status ServerSeat::starting() {
  if (started_server_s_ == 0.0) {
    TROCAR_TRY(const bool is_started, is_answered());
    if (is_started) started_server_s_ = view_.status.server_time_s;
  }
  if (state_ != State::kStarting) return {};
  const bool is_told_since = started_server_s_ > 0.0 && view_.status.server_time_s > started_server_s_;
  if (is_told_since && view_.status.gate_mode == to_string(telemetry::GateMode::kOn)) {
    enter(State::kSettling);
    return {};
  }
  return check_time("the forces did not switch on", "look at the server's log");
}

void ServerSeat::settling() {
  const std::optional<telemetry::TickSample> newest = connection_->newest();
  const bool is_settled =
      request_->is_in_real_hand || (newest && is_near(*newest, kSettled_mm) &&
                                    (axis_of(*newest) - request_->place.X_PN.R().col(2)).norm() < kSettledAxis);
  if (!is_settled && in_state_s_ < kMostSettling_s) return;
  connection_->take_samples();
  last_tick_.reset();
  enter(State::kOn);
}

std::vector<link::NumberedSample> ServerSeat::take_samples() {
  if (state_ != State::kOn) return {};
  std::vector<link::NumberedSample> samples = connection_->take_samples();
  if (connection_->view().welcome.session != session_) {
    // Ticks of the server that came back may be among them: ours are those that follow on without a gap.
    std::uint64_t next = last_tick_ ? *last_tick_ + 1 : 0;
    const auto end = std::find_if(samples.begin(), samples.end(),
                                  [&next](const link::NumberedSample& sample) { return sample.tick != next++; });
    samples.erase(end, samples.end());
  }
  for (const link::NumberedSample& sample : samples) {
    if (last_tick_ && sample.tick > *last_tick_) missing_ += sample.tick - *last_tick_ - 1;
    last_tick_ = sample.tick;
  }
  return samples;
}

void ServerSeat::stop() {
  constexpr milliseconds kStopPatience{500};
  if (view_.is_connected) static_cast<void>(connection_->ask(link::ServerCommand::kStop, kStopPatience));
  view_ = connection_->view();
}

ServerFigures ServerSeat::figures() const {
  ServerFigures figures;
  figures.tool = view_.welcome.tool;
  figures.endpoint = endpoint_;
  figures.server = view_.welcome.server;
  figures.device = view_.welcome.device.name;
  figures.grant = view_.status.grant;
  figures.loop = view_.status.loop;
  figures.ticks_received = view_.ticks_received;
  figures.ticks_missing = view_.ticks_missing;
  figures.returns = returns_ + stalls_;
  return figures;
}

}  // namespace trocar::attempt
