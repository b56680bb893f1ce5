#include "attempt/live/live_attempt.h"

#include <fmt/format.h>

#include <utility>

#include "core/start_thread.h"
#include "io/patient/patient_folder.h"
#include "tasks/operator.h"

namespace trocar::attempt {
namespace {

constexpr std::chrono::milliseconds kBetweenLoopPolls{2};
constexpr double kBeforeEntry_mm = 20.0;

LocalServerOptions server_options(const AttemptOptions& options, const char* tool, const std::string& device) {
  LocalServerOptions of_tool;
  of_tool.tool = tool;
  of_tool.device = device;
  of_tool.rate_hz = options.rate_hz;
  of_tool.priority = options.priority;
  of_tool.flight_folder = options.session.parent_path();
  return of_tool;
}

Pose before_entry(const Segment& path_P) {
  return needle_pose(path_P.a - kBeforeEntry_mm * path_P.direction(), path_P.direction());
}

}  // namespace

LoopOptions loop_options(const cases::OpenCase& open_case, const AttemptOptions& options) {
  LoopOptions loop;
  loop.identity() = options;
  if (loop.operator_name.empty()) loop.operator_name = "trainee";
  loop.patient_source = open_case.choice.patient_source;
  loop.patient_seed = open_case.choice.patient_seed;
  loop.session = options.session;
  loop.X_PN_start = options.X_PN_start.value_or(before_entry(open_case.the_case.plan.line_P));
  loop.X_PT_start = options.X_PT_start.value_or(open_case.X_PT_start);
  loop.is_guided = options.is_guided;
  loop.is_transducer_optional = follows_targets(options.device_probe);
  loop.free_bytes = options.free_bytes;
  return loop;
}

AttemptCase attempt_case(std::shared_ptr<const cases::OpenCase> open_case) {
  AttemptCase of;
  of.server_source = io::absolute_source(open_case->server_source);
  of.plane = open_case->plane();
  const cases::Case* const the_case = &open_case->the_case;
  of.the_case = {std::move(open_case), the_case};
  return of;
}

AttemptOperators trainee_operators(const cases::OpenCase& open_case, const AttemptOptions& options) {
  AttemptOperators operators;
  operators.needle.rate_hz = options.rate_hz;
  operators.needle.force_model = options.force_model.empty() ? open_case.force_model : options.force_model;
  return operators;
}

LiveAttempt::LiveAttempt(std::shared_ptr<const cases::OpenCase> open_case, AttemptOptions options,
                         std::shared_ptr<HapticServers> servers)
    : AttemptExchange(std::make_shared<SteadyClock>()), options_(std::move(options)) {
  auto thread = start_stoppable_thread(
      "attempt", [this, open = std::move(open_case), kept = std::move(servers)](const std::stop_token& stop) mutable {
        run(stop, std::move(open), std::move(kept));
      });
  if (thread) {
    thread_ = *std::move(thread);
  } else {
    publish_failure(std::move(thread).error());
  }
}

LiveAttempt::~LiveAttempt() = default;

Result<std::shared_ptr<HapticServers>> LiveAttempt::find_servers(std::shared_ptr<HapticServers> kept) const {
  std::error_code ignored;
  if (std::filesystem::exists(options_.session, ignored))
    return fail_usage("there is a session of that name already", options_.session.string(), "choose another name");
  const LocalServerOptions needle = server_options(options_, "needle", options_.device_needle);
  std::optional<LocalServerOptions> transducer;
  if (options_.has_probe) transducer = server_options(options_, "probe", options_.device_probe);
  if (kept && kept->fits(needle, transducer)) return kept;
  kept.reset();  // ends their processes, and releases their devices, before others are started
  return HapticServers::start(needle, transducer);
}

void LiveAttempt::publish_failure(Error error) {
  AttemptUpdate failed;
  failed.view.phase = AttemptPhase::kFailed;
  failed.result = tl::unexpected(std::move(error));
  publish(std::move(failed));
}

void LiveAttempt::run(const std::stop_token& stop, std::shared_ptr<const cases::OpenCase> open_case,
                      std::shared_ptr<HapticServers> kept) {
  AttemptUpdate starting;
  starting.view.progress = "starting the haptic servers";
  publish(std::move(starting));
  Result<std::shared_ptr<HapticServers>> found = find_servers(std::move(kept));
  if (!found) return publish_failure(found.error());
  SteadyClock clock;
  const SupervisionOptions supervision{Recovery::kAll, options_.timeout, "trocar-trainer", true};
  ToolSupervisors supervisors = (*found)->supervise(supervision, clock);
  AttemptLoop loop(attempt_case(open_case), loop_options(*open_case, options_), trainee_operators(*open_case, options_),
                   *std::move(found), std::move(supervisors), clock, *this);
  while (!stop.stop_requested() && loop.poll()) clock.sleep_for(kBetweenLoopPolls);
  loop.leave();
}

std::optional<Result<RunResult>> LiveAttempt::take_result() {
  std::optional<Result<RunResult>> result = AttemptExchange::take_result();
  if (!result || !*result) return result;
  RunResult& scored = **result;
  if (scored.ticks_missing > 0)
    scored.warnings.push_back(
        fmt::format("{} ticks of the needle did not arrive: the session has gaps there", scored.ticks_missing));
  constexpr double kShown_s = 0.05;  // 0.1 s in the words
  if (scored.paused_s >= kShown_s)
    scored.warnings.push_back(
        fmt::format("the needle's server was away: {:.1f} s are missing from the session", scored.paused_s));
  return result;
}

}  // namespace trocar::attempt
