#include "attempt/live/realtime_session.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "attempt/live/attempt_loop.h"
#include "attempt/servers/server_hosts.h"
#include "attempt/tools/tool_motion.h"
#include "core/interruption.h"
#include "io/patient/patient_folder.h"
#include "link/endpoint.h"

namespace trocar::attempt {
namespace {

constexpr std::chrono::milliseconds kBetweenViews{1};
constexpr double kSameRate_hz = 0.5;

using Hosts = std::vector<std::unique_ptr<ServerHost>>;

/// Two servers with simulated devices; flight records of a fault are written beside the session.
Result<Hosts> start_own(const RunOptions& options, double rate_hz) {
  Hosts hosts;
  for (const char* tool : {"needle", "probe"}) {
    LocalServerOptions of_tool;
    of_tool.tool = tool;
    of_tool.device = "virtual:" + options.device;
    of_tool.rate_hz = rate_hz;
    of_tool.flight_folder = options.session.parent_path();
    TROCAR_TRY(std::unique_ptr<LocalServer> host, LocalServer::start(of_tool));
    hosts.push_back(std::move(host));
  }
  return hosts;
}

Result<Hosts> make_hosts(const RealtimeOptions& realtime, const RunOptions& options, double own_rate_hz) {
  if (realtime.endpoints.empty()) return start_own(options, own_rate_hz);
  Hosts hosts;
  for (const std::string& endpoint : realtime.endpoints)
    hosts.push_back(std::make_unique<RemoteServer>(endpoint, realtime.security));
  return hosts;
}

/// The rate at which the operator performs: that of the needle's server.
Status take_rate(const ServerSupervisor& needle, Performer& performer) {
  const double rate_hz = needle.client().status.loop.wanted_hz;
  if (performer.has_own_rate && std::abs(rate_hz - performer.rate_hz) > kSameRate_hz)
    return fail(
        fmt::format("the session was recorded at {:.0f} Hz, the server runs at {:.0f}", performer.rate_hz, rate_hz),
        needle.host().endpoint(), fmt::format("start it with --rate {:.0f}", performer.rate_hz));
  performer.rate_hz = rate_hz;
  return {};
}

AttemptCase attempt_case(const cases::Case& the_case, const RunOptions& options) {
  return {std::make_shared<const cases::Case>(the_case), io::absolute_source(options.patient_source), {}};
}

LoopOptions loop_options(const RunOptions& options) {
  LoopOptions loop;
  loop.identity() = options;
  loop.session = options.session;
  loop.has_view = false;
  loop.longest_s = kLongestAttempt_s;
  loop.scores_unsaved = false;
  loop.ends_with_needle_server = true;
  return loop;
}

void report_view(const Progress& progress, const AttemptView& view) {
  if (view.phase == AttemptPhase::kStarting)
    return report(progress, "loading the servers' scenes", view.progress_fraction);
  report(progress, view.phase == AttemptPhase::kServerLost ? "waiting for the needle's server" : "performing",
         view.needle.time_s / kLongestAttempt_s);
}

void warn_of_gaps(RunResult& result) {
  if (result.ticks_missing > 0)
    result.warnings.push_back(
        fmt::format("{} ticks of the needle did not arrive: the session has gaps there", result.ticks_missing));
  if (result.paused_s > 0.0)
    result.warnings.push_back(
        fmt::format("the needle server was unavailable: {:.1f} s are missing in the session, and the needle resumed at "
                    "its last pose",
                    result.paused_s));
  if (result.unseen_s > 0.0)
    result.warnings.push_back(
        fmt::format("the computer was too busy: the attempt was paused for {:.2f} s in total", result.unseen_s));
}

Error interrupted(bool is_recorded, const RunOptions& options) {
  if (!is_recorded) return interruption_error("trocar run");
  return {"interrupted: the session is kept as an incomplete one", options.session.string(),
          "run the command again; it is kept under another name then"};
}

Result<RunResult> perform_until_done(AttemptLoop& loop, AttemptExchange& exchange, const RunOptions& options,
                                     Clock& clock, const Progress& progress) {
  while (loop.poll()) {
    const AttemptView view = exchange.view();
    if (is_interrupted()) {
      loop.abandon();
      return tl::unexpected(interrupted(view.phase != AttemptPhase::kStarting, options));
    }
    report_view(progress, view);
    clock.sleep_for(kBetweenViews);
  }
  Result<RunResult> result = *exchange.take_result();
  if (result) warn_of_gaps(*result);
  return result;
}

Result<RunResult> perform_through(Hosts hosts, const cases::Case& the_case, const RunOptions& options,
                                  Performer performer, std::chrono::milliseconds timeout,
                                  const std::shared_ptr<Clock>& clock, const Progress& progress) {
  const InterruptibleWork interruptible;
  const SupervisionOptions supervision{Recovery::kReturnsOnly, timeout, "trocar run", false};
  TROCAR_TRY(IdentifiedServers found, identify_servers(std::move(hosts), supervision, *clock, progress));
  TROCAR_TRY_STATUS(take_rate(*found.supervisors.needle, performer));
  AttemptOperators operators{std::move(performer), true,
                             std::make_unique<RestingTransducer>(*the_case.patient, the_case.plan.line_P)};
  AttemptExchange exchange(clock);
  AttemptLoop loop(attempt_case(the_case, options), loop_options(options), std::move(operators),
                   std::move(found.servers), std::move(found.supervisors), *clock, exchange);
  return perform_until_done(loop, exchange, options, *clock, progress);
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
    TROCAR_TRY_STATUS(client.wait_connected(options.timeout));
  }
  return {};
}

Result<RunResult> run_realtime_session(const cases::Case& the_case, const RunOptions& given,
                                       const RealtimeOptions& realtime, const Progress& progress) {
  TROCAR_TRY_STATUS(check_run(given));
  TROCAR_TRY_STATUS(check_realtime(realtime));
  TROCAR_TRY(Performer performer, make_performer(the_case, given));
  const RunOptions options = options_of(performer, given);
  TROCAR_TRY(Hosts hosts, make_hosts(realtime, options, performer.rate_hz));
  return perform_through(std::move(hosts), the_case, options, std::move(performer), realtime.timeout,
                         std::make_shared<SteadyClock>(), progress);
}

Result<RunResult> run_realtime_session(const cases::Case& the_case, const RunOptions& given,
                                       std::vector<std::unique_ptr<ServerHost>> servers,
                                       std::chrono::milliseconds timeout, std::shared_ptr<Clock> clock,
                                       const Progress& progress) {
  TROCAR_TRY_STATUS(check_run(given));
  TROCAR_TRY(Performer performer, make_performer(the_case, given));
  const RunOptions options = options_of(performer, given);
  return perform_through(std::move(servers), the_case, options, std::move(performer), timeout, clock, progress);
}

}  // namespace trocar::attempt
