#include "attempt/live/realtime_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <thread>

#include "attempt/hands/resting_transducer.h"
#include "attempt/live/live_operator.h"
#include "attempt/servers/detail/own_servers.h"
#include "attempt/servers/link_connection.h"
#include "attempt/servers/server_seat.h"
#include "cases/scene_request.h"
#include "core/interruption.h"
#include "io/patient/patient_source.h"
#include "link/endpoint.h"

namespace trocar::attempt {
namespace {

using State = ServerSeat::State;

constexpr std::chrono::milliseconds kBetweenLooks{1};
constexpr double kSameRate_hz = 0.5;
/// Older ticks arrive too late for a reply: a server's hand stops without messages for this time, and the operator's
/// must not have moved on meanwhile.
constexpr double kAnswered_s = 0.05;

Status check_interruption() {
  return is_interrupted() ? tl::unexpected(interruption_error("trocar run")) : Status{};
}

/// The servers of an attempt: the needle's, and optionally the probe's.
class LiveServers {
 public:
  /// Connected and identified, without a scene.
  static Result<LiveServers> connect(const RunOptions& options, const RealtimeOptions& realtime, double own_rate_hz,
                                     const Progress& progress);

  ServerSeat& needle() { return needle_.front(); }
  bool has_probe() const { return !probe_.empty(); }
  void hold(const SeatRequest& needle, const SeatRequest& probe);
  /// Waits until all of them have reached that state.
  Status wait_for(State state, const Progress& progress);

  /// Advances all of them. Errors: those of the needle's server; without the probe's server the attempt continues.
  Result<State> look();
  /// Moves the transducer's hand and records its virtual pose.
  Status move_probe(const ProbeHand& hand, LiveOperator& live);
  void stop();
  void tell(RunResult& result);

 private:
  std::optional<OwnServers> own_;
  std::vector<ServerSeat> needle_, probe_;  ///< At most one.
  std::vector<ServerFigures> lost_;
  std::vector<std::string> warnings_;
  std::optional<double> probe_on_s_;
};

Result<LiveServers> LiveServers::connect(const RunOptions& options, const RealtimeOptions& realtime, double own_rate_hz,
                                         const Progress& progress) {
  LiveServers servers;
  std::vector<std::string> endpoints = realtime.endpoints;
  if (endpoints.empty()) {
    TROCAR_TRY(servers.own_, OwnServers::start(options, own_rate_hz));
    endpoints = servers.own_->endpoints();
  }
  std::vector<ServerSeat> seats;
  for (const std::string& endpoint : endpoints) {
    link::ClientOptions client;
    client.endpoint = endpoint;
    client.name = "trocar run";
    client.security = realtime.security;
    TROCAR_TRY(std::unique_ptr<ServerConnection> connection, connect_by_link(client));
    seats.emplace_back(std::move(connection), endpoint, realtime.patience, *realtime.clock);
  }
  const auto is_ready = [](const ServerSeat& seat) { return seat.state() == State::kReady; };
  while (!std::all_of(seats.begin(), seats.end(), is_ready)) {
    TROCAR_TRY_STATUS(check_interruption());
    report(progress, "waiting for the haptic servers", 0.0);
    for (const char* tool : {"needle", "probe"})
      if (servers.own_) TROCAR_TRY_STATUS(servers.own_->check(tool));
    for (ServerSeat& seat : seats) TROCAR_TRY_STATUS(seat.look());
    std::this_thread::sleep_for(kBetweenLooks);
  }
  for (ServerSeat& seat : seats) {
    const std::string tool = seat.view().welcome.tool;
    std::vector<ServerSeat>* place = tool == "needle" ? &servers.needle_ : tool == "probe" ? &servers.probe_ : nullptr;
    if (place == nullptr || !place->empty())
      return fail(
          fmt::format("{} server of the {} is not needed for an attempt", place == nullptr ? "the" : "a second", tool),
          seat.endpoint(), "name one of the needle and at most one of the probe");
    place->push_back(std::move(seat));
  }
  if (servers.needle_.empty())
    return fail("no needle server among the endpoints", endpoints.front(), "start trocar-hapticd --tool needle");
  return servers;
}

void LiveServers::hold(const SeatRequest& needle, const SeatRequest& probe) {
  needle_.front().hold(needle);
  if (has_probe()) probe_.front().hold(probe);
}

Status LiveServers::wait_for(State state, const Progress& progress) {
  while (true) {
    TROCAR_TRY_STATUS(check_interruption());
    TROCAR_TRY(const State of_needle, look());
    if (of_needle == state && (!has_probe() || probe_.front().state() == state)) return {};
    double loading = needle_.front().loading();
    if (has_probe()) loading = std::max(loading, probe_.front().loading());
    report(progress, "loading the servers' scenes", loading);
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

Result<State> LiveServers::look() {
  if (has_probe()) {
    Status probe = own_ ? own_->check("probe") : Status{};
    if (probe) {
      if (const auto state = probe_.front().look(); !state) probe = tl::unexpected(state.error());
    }
    if (!probe) {
      warnings_.push_back("the attempt continues without the probe: " + probe.error().text());
      lost_.push_back(probe_.front().figures());
      probe_.clear();
    }
  }
  if (own_) TROCAR_TRY_STATUS(own_->check("needle"));
  return needle_.front().look();
}

Status LiveServers::move_probe(const ProbeHand& hand, LiveOperator& live) {
  if (!has_probe()) return {};
  ServerSeat& probe = probe_.front();
  if (probe.state() != State::kOn) {
    probe_on_s_.reset();
    return {};
  }
  const std::vector<link::NumberedSample> samples = probe.take_samples();
  if (samples.empty()) return {};
  const double now_s = samples.back().sample.time_s;
  if (!probe_on_s_) probe_on_s_ = now_s;
  link::HandTarget target = hand.at(now_s - *probe_on_s_);
  target.server_time_s = now_s;
  probe.set_hand(target);
  return live.note_transducer(samples, probe.view().clock_offset_s);
}

void LiveServers::stop() {
  for (std::vector<ServerSeat>* seats : {&needle_, &probe_})
    for (ServerSeat& seat : *seats) seat.stop();
}

void LiveServers::tell(RunResult& result) {
  for (const std::vector<ServerSeat>* seats : {&needle_, &probe_})
    for (const ServerSeat& seat : *seats) result.servers.push_back(seat.figures());
  result.servers.insert(result.servers.end(), lost_.begin(), lost_.end());
  result.ticks_missing = needle_.front().ticks_missing();
  result.warnings.insert(result.warnings.begin(), warnings_.begin(), warnings_.end());
}

/// Initial hand poses of needle and transducer.
SeatRequest needle_request(const cases::Case& the_case, const cases::SceneChoice& choice,
                           const tasks::HandCommand& first, const Performer& performer) {
  SeatRequest request{cases::scene_request(the_case, choice), hand_target(first, 0.0)};
  if (!performer.parameters.empty()) request.parameters = cases::as_command(performer.parameters.front());
  return request;
}
SeatRequest probe_request(const cases::Case& the_case, cases::SceneChoice choice, const ProbeHand& hand) {
  choice.tool = "probe";
  SeatRequest request{cases::scene_request(the_case, choice), hand.at(0.0)};
  request.scene.X_PW = hand.room(request.scene.X_PW);
  return request;
}

SceneParameters parameters_of(const ServerSeat& needle) {
  const SceneParameters* const newest = needle.scenes().newest();
  return newest == nullptr ? SceneParameters{} : *newest;
}

/// The changes of parameters of a replayed session, sent after the same number of ticks. The server reports the first
/// tick with them.
class ReplayedChanges {
 public:
  explicit ReplayedChanges(const Performer& performer) : parameters_(performer.parameters) {}

  void send(ServerSeat& needle, std::size_t ticks) {
    while (next_ < parameters_.size() && parameters_[next_].tick <= ticks) {
      const link::SetParameters command = cases::as_command(parameters_[next_++]);
      needle.adjust(command);
      needle.send(command);
    }
  }

 private:
  std::span<const storage::SessionParameters> parameters_;
  std::size_t next_ = 1;  ///< The first ones are those of the scene.
};

/// The closed loop through the servers, until the operator has finished.
Status perform(LiveServers& servers, LiveOperator& live, AttemptRecord& record, ReplayedChanges changes,
               const ProbeHand& probe_hand, const Progress& progress) {
  bool was_on = false;
  while (true) {
    TROCAR_TRY_STATUS(check_interruption());
    // Ticks first: when look() detects a change of the server, all ticks of the old one have been taken.
    ServerSeat& needle = servers.needle();
    const std::vector<link::NumberedSample> samples = needle.take_samples();
    if (!samples.empty() && !was_on) live.begin(needle.view().clock_offset_s);
    was_on = needle.state() == State::kOn && (was_on || !samples.empty());
    for (const link::NumberedSample& sample : samples) {
      bool goes_on = true;
      if (sample.sample.time_s < samples.back().sample.time_s - kAnswered_s) {
        TROCAR_TRY_STATUS(live.take_unseen(sample.sample));
      } else {
        TROCAR_TRY(goes_on, live.take(sample.sample));
      }
      TROCAR_TRY_STATUS(record.note_scene(sample.scene, needle.scenes()));
      if (!goes_on) return {};
    }
    if (!samples.empty()) {
      needle.set_hand(live.hand());
      needle.place_at(live.X_PN_to_resume());
      changes.send(needle, record.samples().size());
      needle.take_replies();  // they describe the scenes
    }
    TROCAR_TRY_STATUS(servers.move_probe(probe_hand, live));
    report(progress, was_on ? "performing" : "waiting for the needle's server", live.time_s() / kLongestAttempt_s);
    TROCAR_TRY_STATUS(servers.look());
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

void warn_of_gaps(const LiveOperator& live, RunResult& result) {
  if (result.ticks_missing > 0)
    result.warnings.push_back(
        fmt::format("{} ticks of the needle did not arrive: the session has gaps there", result.ticks_missing));
  if (live.paused_s() > 0.0)
    result.warnings.push_back(
        fmt::format("the needle server was unavailable: {:.1f} s are missing in the session, and the needle resumed at "
                    "its last pose",
                    live.paused_s()));
  if (live.unseen_s() > 0.0)
    result.warnings.push_back(
        fmt::format("the computer was too busy: the attempt was paused for {:.2f} s in total", live.unseen_s()));
}

}  // namespace

Status check_realtime(const RealtimeOptions& options) {
  if (options.endpoints.size() > 2)
    return fail_usage("an attempt has two servers at most", "--endpoint", "name the needle's and the probe's");
  for (const std::string& text : options.endpoints) {
    TROCAR_TRY(const link::Endpoint endpoint, link::parse_endpoint(text));
    if (endpoint.needs_keys && !options.security)
      return fail_usage("a server on tcp:// needs keys", text, "give --keys and --server-key, or use ipc://");
  }
  if (options.endpoints.size() == 2 && options.endpoints[0] == options.endpoints[1])
    return fail_usage("the same server was given twice", options.endpoints[0], "name the needle's and the probe's");
  return {};
}

Status find_servers(const RealtimeOptions& options) {
  if (options.endpoints.empty()) TROCAR_TRY_STATUS(link::find_server_program());
  for (const std::string& endpoint : options.endpoints) {
    link::ClientOptions watcher;
    watcher.endpoint = endpoint;
    watcher.wants_control = false;
    watcher.security = options.security;
    TROCAR_TRY(link::HapticClient client, link::HapticClient::connect(watcher));
    TROCAR_TRY_STATUS(client.wait_connected(options.patience));
  }
  return {};
}

Result<RunResult> run_realtime_session(const cases::Case& the_case, const RunOptions& given,
                                       const RealtimeOptions& realtime, const Progress& progress) {
  TROCAR_TRY_STATUS(check_run(given));
  TROCAR_TRY_STATUS(check_realtime(realtime));
  TROCAR_TRY(Performer performer, make_performer(the_case, given));
  const RunOptions options = options_of(performer, given);
  const InterruptibleWork interruptible;
  TROCAR_TRY(LiveServers servers, LiveServers::connect(options, realtime, performer.rate_hz, progress));
  const link::ClientView welcome = servers.needle().view();
  const double rate_hz = welcome.status.loop.wanted_hz;
  if (performer.has_own_rate && std::abs(rate_hz - performer.rate_hz) > kSameRate_hz)
    return fail(
        fmt::format("the session was recorded at {:.0f} Hz, the server runs at {:.0f}", performer.rate_hz, rate_hz),
        servers.needle().endpoint(), fmt::format("start it with --rate {:.0f}", performer.rate_hz));
  performer.rate_hz = rate_hz;

  tasks::OperatorView before;
  before.dt_s = 1.0 / rate_hz;
  const tasks::HandCommand first = performer.the_operator->next(before);
  cases::SceneChoice choice;
  choice.force_model = performer.force_model;
  choice.patient_source = io::absolute_source(options.patient_source);
  choice.patient_seed = options.patient_seed;
  choice.seed = options.seed;
  const ProbeHand probe_hand(*the_case.patient, the_case.plan.line_P);
  servers.hold(needle_request(the_case, choice, first, performer), probe_request(the_case, choice, probe_hand));
  TROCAR_TRY_STATUS(servers.wait_for(State::kOn, progress));

  const AttemptFacts facts{fmt::format("{}, {}, through {}", welcome.welcome.device.name, welcome.welcome.device.title,
                                       welcome.welcome.server),
                           rate_hz, performer.force_model, preset_of_device(welcome.welcome.device.name),
                           parameters_of(servers.needle())};
  TROCAR_TRY(AttemptRecord record, AttemptRecord::create(the_case, options, facts));
  LiveOperator live(performer, record, first);
  servers.needle().take_samples();  // at rest, while the probe's server was still busy
  const Status performed = perform(servers, live, record, ReplayedChanges(performer), probe_hand, progress);
  servers.stop();
  if (!performed && is_interrupted())
    return fail("interrupted: the session is kept as an incomplete one", options.session.string(),
                "run the command again; it is kept under another name then");
  TROCAR_TRY_STATUS(performed);
  TROCAR_TRY(RunResult result, record.finish());
  servers.tell(result);
  warn_of_gaps(live, result);
  return result;
}

}  // namespace trocar::attempt
