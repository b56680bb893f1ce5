// trocar run: an attempt by a scripted operator.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "anatomy/structure_words.h"
#include "attempt/live/realtime_session.h"
#include "cli/breathing_option.h"
#include "cli/commands.h"
#include "cli/constants.h"
#include "cli/patient_option.h"
#include "cli/session/past_sessions.h"
#include "cli/session/replay_arguments.h"
#include "cli/session/run_results.h"
#include "config/json.h"
#include "io/patient/patient_cache.h"
#include "phantom/phantom.h"
#include "report/session_analysis.h"
#include "storage/score_json.h"
#include "storage/ticks_hash.h"
#include "tasks/fit_to_patient.h"

namespace trocar::cli {
namespace {

struct RunArguments {
  cases::CaseOptions the_case;
  attempt::RunOptions run;
  io::PatientSource source;
  bool is_json = false;
  bool is_realtime = false;
  attempt::RealtimeOptions realtime;
  std::string key_file, server_key_file;
  double timeout_s = 5.0;
  NamedOptions named;
  std::string person, database;
};

config::Json latency_json(const realtime::LatencySummary& latency) {
  return {
      {"p50_us", latency.p50_us}, {"p99_us", latency.p99_us}, {"p999_us", latency.p999_us}, {"max_us", latency.max_us}};
}

config::Json servers_json(const std::vector<attempt::ServerFigures>& servers) {
  config::Json all = config::Json::array();
  for (const attempt::ServerFigures& server : servers) {
    all.push_back({{"tool", server.tool},
                   {"endpoint", server.endpoint},
                   {"server", server.server},
                   {"device", server.device},
                   {"real_time", server.grant},
                   {"wanted_hz", server.loop.wanted_hz},
                   {"achieved_hz", server.loop.achieved_hz},
                   {"periods", server.loop.periods},
                   {"periods_missed", server.loop.missed},
                   {"periods_served", server.loop.served()},
                   {"lateness", latency_json(server.loop.lateness)},
                   {"tick", latency_json(server.loop.tick)},
                   {"ticks_received", server.ticks_received},
                   {"ticks_missing", server.ticks_missing},
                   {"returns", server.returns}});
  }
  return all;
}

void print_server(const attempt::ServerFigures& server) {
  const realtime::LoopSummary& loop = server.loop;
  fmt::print("server of the {}: {}, {}, {}\n", server.tool, server.server, server.device, server.endpoint);
  fmt::print("  {:.1f} of {:.0f} Hz, {:.3f} % of {} periods served; lateness p99 {:.0f} us, tick p99 {:.0f} us\n",
             loop.achieved_hz, loop.wanted_hz, 100.0 * loop.served(), loop.periods, loop.lateness.p99_us,
             loop.tick.p99_us);
  fmt::print("  {} ticks received, {} missing; {}\n", server.ticks_received, server.ticks_missing, server.grant);
}

/// Whether a replay gave the session's ticks bit by bit; empty: no replay, or the session is too old to tell.
std::optional<bool> has_same_ticks(const attempt::RunOptions& run, const attempt::RunResult& result) {
  if (run.replayed == nullptr || run.replayed->ticks_hash.empty() || result.ticks_hash.empty()) return std::nullopt;
  return storage::hash_ticks(run.replayed->samples) == result.ticks_hash;
}

config::Json result_json(const RunArguments& arguments, const cases::Case& the_case, const attempt::RunResult& result) {
  const scoring::Outcome& outcome = result.outcome;
  config::Json punctures = config::Json::array();
  for (const attempt::PunctureRecord& puncture : result.punctures) {
    punctures.push_back({{"layer", puncture.layer},
                         {"time_s", puncture.time_s},
                         {"depth_mm", puncture.depth_mm},
                         {"peak_n", puncture.peak_n}});
  }
  config::Json hints = config::Json::array();
  for (const scoring::Hint& hint : outcome.hints) hints.push_back(hint.text);
  const scoring::BiopsyCore* const best = outcome.best_core();
  config::Json json = {
      {"session", arguments.run.session.string()},
      {"task", the_case.task.name},
      {"patient", the_case.patient->name},
      {"patient_hash", the_case.patient->content_hash},
      {"patient_seed", arguments.run.patient_seed},
      {"seed", arguments.run.seed},
      {"needle", the_case.needle.name},
      {"level", the_case.task.level},
      {"force_model", result.force_model},
      {"operator", arguments.run.operator_name},
      {"device", arguments.run.device},
      {"parenchymal", the_case.is_parenchymal},
      {"posture", std::string(anatomy::posture_name(tasks::posture_of(the_case.task, *the_case.patient)))},
      {"simulated_s", result.simulated_s},
      {"active_s", result.active_s},
      {"ticks", result.ticks},
      {"ticks_hash", result.ticks_hash},
      {"punctures", punctures},
      {"core", best != nullptr ? storage::core_json(*best) : config::Json(nullptr)},
      {"hints", hints}};
  json.update(storage::outcome_json(outcome));
  if (const auto same = has_same_ticks(arguments.run, result)) json["same_ticks_as_session"] = *same;
  if (arguments.is_realtime) {
    json["ticks_missing"] = result.ticks_missing;
    json["servers"] = servers_json(result.servers);
  }
  json["warnings"] = result.warnings;
  return json;
}

void print_part(const scoring::ScorePart& part) {
  if (scoring::is_deduction(part)) {
    fmt::print("  {:<44} {:>13} {:>6.1f} points\n", part.title, "", part.points);
  } else {
    fmt::print("  {:<44} {:>12} {:>6.1f} of {:.1f} points\n", part.title, scoring::part_value_text(part), part.points,
               part.max_points);
  }
}

/// Passed or not with the reasons, then what to improve.
void print_verdict(const scoring::Outcome& outcome) {
  if (outcome.is_scored()) {
    fmt::print("score {:.0f} of 100, target {}: {}\n", outcome.score, scoring::target_words(outcome),
               outcome.is_passed ? "passed" : fmt::format("not passed ({})", fmt::join(outcome.fails, "; ")));
  } else {
    fmt::print("not passed: not scored, {}\n", outcome.not_scored);
  }
  for (std::size_t n = 0; n < outcome.hints.size(); ++n) {
    const scoring::Hint& hint = outcome.hints[n];
    fmt::print("{}{}\n", report::is_praise(hint) ? "" : n == 0 ? "improve first: " : "then: ", hint.text);
  }
}

void print_result(const RunArguments& arguments, const cases::Case& the_case, const attempt::RunResult& result) {
  const scoring::Outcome& outcome = result.outcome;
  fmt::print("{} on {} by {}: {:.1f} s, {} ticks\n", the_case.task.title, the_case.patient->name,
             arguments.run.operator_name, result.simulated_s, result.ticks);
  print_verdict(outcome);
  if (const anatomy::Posture posture = tasks::posture_of(the_case.task, *the_case.patient);
      posture != the_case.patient->posture)
    fmt::print("with the patient {}\n", anatomy::posture_words(posture));
  if (!the_case.tissues.origin.empty()) fmt::print("tissues: {}\n", the_case.tissues.origin);
  if (the_case.is_parenchymal) fmt::print("no lesion in this patient: the target is in healthy tissue\n");
  for (const attempt::PunctureRecord& p : result.punctures) {
    fmt::print("  puncture of {:<16} at {:6.2f} s, {:5.1f} mm deep, {:.2f} N\n", p.layer, p.time_s, p.depth_mm,
               p.peak_n);
  }
  for (const scoring::BiopsyCore& core : outcome.cores)
    fmt::print("  core: {:.1f} mm target, {:.1f} mm organ, {:.1f} mm vessel, {:.1f} mm other\n", core.target_mm,
               core.organ_mm, core.vessel_mm, core.other_mm);
  if (outcome.bleeding)
    fmt::print("risk of bleeding: {}{}{}\n", to_string(outcome.bleeding->risk),
               outcome.bleeding->reasons.empty() ? "" : ", ", fmt::join(outcome.bleeding->reasons, "; "));
  for (const metrics::HarmEvent& event : outcome.harms)
    fmt::print("{} harm: {}{}\n", to_string(event.grade), metrics::harm_words(event),
               event.reason.empty() ? "" : " (" + event.reason + ")");
  for (const scoring::ScorePart& part : outcome.parts) print_part(part);
  if (const auto same = has_same_ticks(arguments.run, result))
    fmt::print("{}\n",
               *same ? "the ticks are those of the session, to the bit" : "the ticks differ from the session's");
  for (const attempt::ServerFigures& server : result.servers) print_server(server);
}

/// Checks the options of live servers for conflicts.
Status check_servers(RunArguments& a) {
  const bool names_servers = !a.realtime.endpoints.empty() || !a.key_file.empty() || !a.server_key_file.empty();
  if (names_servers && !a.is_realtime)
    return fail_usage("these options need --realtime", "--endpoint, --keys, --server-key", "add --realtime");
  if (!a.is_realtime) return {};
  if (a.key_file.empty() != a.server_key_file.empty())
    return fail_usage("--keys and --server-key must be given together", "--keys, --server-key",
                      "give both; trocar link keygen makes them");
  if (!a.realtime.endpoints.empty() && (a.named.has("--device") || a.named.has("--rate")))
    return fail_usage("a running server has a fixed device and rate", "--device, --rate",
                      "set them when you start trocar-hapticd");
  if (!a.key_file.empty()) {
    link::ClientSecurity security;
    TROCAR_TRY(security.keys, link::load_curve_keys(a.key_file));
    TROCAR_TRY(security.server_key, link::load_public_key(a.server_key_file));
    a.realtime.security = std::move(security);
  }
  a.realtime.timeout = std::chrono::milliseconds(static_cast<int>(1000.0 * a.timeout_s));
  return attempt::check_realtime(a.realtime);
}

/// Checks that the session can be written: an interrupted run's session is kept under another name; any other file is
/// an error.
Status prepare_session_file(const std::filesystem::path& session) {
  TROCAR_TRY(const auto kept_as, storage::set_aside_incomplete_session(session));
  if (kept_as)
    print_warning(fmt::format("{} is the incomplete session of an interrupted run — kept as {}", session.string(),
                              kept_as->string()));
  return check_new(session);
}

/// Checks the case before a patient is opened.
Status check_case(const RunArguments& arguments) {
  const attempt::RunOptions& run = arguments.run;
  if (run.replayed == nullptr) {
    TROCAR_TRY_STATUS(cases::load_tables(arguments.the_case));
    return {};
  }
  TROCAR_TRY_STATUS(attempt::replay_parameters(*run.replayed, run.replay_changes));
  warn_of_forces(run.replayed->info, run.operator_name);
  if (run.replay_changes.is_any())
    print_warning(
        "the replay uses other tissues or another force model than the session: its forces differ from the recorded "
        "ones");
  return {};
}

Result<cases::Case> make_case(const RunArguments& arguments, anatomy::VirtualPatient opened, const Progress& progress) {
  auto patient = std::make_shared<const anatomy::VirtualPatient>(std::move(opened));
  const attempt::RunOptions& run = arguments.run;
  if (run.replayed == nullptr) return cases::prepare_case(std::move(patient), arguments.the_case, progress);
  TROCAR_TRY(const auto parameters, attempt::replay_parameters(*run.replayed, run.replay_changes));
  return attempt::restore_case(std::move(patient), *run.replayed, parameters.front(), run.is_other_patient_meant);
}

/// The level's changes of the body: an embedded patient with other numbers.
Status change_body(RunArguments& arguments) {
  if (arguments.the_case.level.empty() || arguments.run.replayed != nullptr) return {};
  TROCAR_TRY(const cases::Case tables, cases::load_tables(arguments.the_case));
  const tasks::Tier* const level = tasks::level_of(tables.task);
  if (level == nullptr || level->body.empty()) return {};
  std::string& source = arguments.source.folder_or_name;
  if (io::is_path(source) || !phantom::has_body(source)) {
    print_warning(fmt::format("the level \"{}\" cannot change the body of {}: only embedded cases have one to change",
                              level->name, source));
    return {};
  }
  source = cases::with_body(source, *level);
  arguments.run.patient_source = source;
  return {};
}

Status run_task(RunArguments& arguments) {
  attempt::RunOptions& run = arguments.run;
  TROCAR_TRY_STATUS(attempt::check_run(run));
  TROCAR_TRY_STATUS(restore_arguments(arguments.named, arguments.the_case, run, arguments.source));
  TROCAR_TRY_STATUS(prepare_session_file(run.session));
  run.patient_source = arguments.source.folder_or_name;
  run.patient_seed = arguments.source.seed;
  arguments.the_case.seed = run.seed;
  arguments.the_case.patient_folder = arguments.source.folder_or_name;
  TROCAR_TRY_STATUS(change_body(arguments));
  TROCAR_TRY_STATUS(check_servers(arguments));
  TROCAR_TRY_STATUS(check_case(arguments));
  if (arguments.is_realtime) TROCAR_TRY_STATUS(attempt::find_servers(arguments.realtime));
  if (arguments.person.empty() && !arguments.database.empty())
    return fail_usage("a database is of use for a person only", "--db", "add --person NAME");
  std::optional<results::Repository> repository;
  if (!arguments.person.empty()) {
    TROCAR_TRY(repository, open_for_person(arguments.person, arguments.database, run));
  }
  cases::Case the_case;
  attempt::RunResult result;
  {
    const ProgressPrinter printer;
    TROCAR_TRY(anatomy::VirtualPatient patient, io::open_patient(arguments.source, printer.callback()));
    TROCAR_TRY(the_case, make_case(arguments, std::move(patient), printer.callback()));
    if (repository && arguments.is_realtime) TROCAR_TRY_STATUS(record_begin(*repository, the_case, run));
    TROCAR_TRY(result, arguments.is_realtime
                           ? attempt::run_realtime_session(the_case, run, arguments.realtime, printer.callback())
                           : attempt::run_session(the_case, run, printer.callback()));
  }
  if (repository) TROCAR_TRY_STATUS(record_end(*repository, run));
  for (const std::string& warning : result.warnings) print_warning(warning);
  if (arguments.is_json) {
    print_json(result_json(arguments, the_case, result));
  } else {
    print_result(arguments, the_case, result);
  }
  return {};
}

void add_server_options(Command& command, RunArguments& a) {
  command.add_flag(
      "--realtime", a.is_realtime,
      "Run in real time through live haptic servers; without --endpoint, two servers (needle and probe) are started");
  command
      .add_option("--endpoint", a.realtime.endpoints,
                  "Endpoint of a running trocar-hapticd: ipc://PATH, or tcp://ADDRESS:PORT with --keys; repeat it for "
                  "a second one, in any order")
      .one_value_each();
  command.add_option("--keys", a.key_file, "Your private key file, for servers on other machines (trocar link keygen)");
  command.add_option("--server-key", a.server_key_file, "The servers' public key");
  command.add_option("--patience", a.timeout_s, "Time without messages until a server counts as lost")
      .number_within(0.1, 600.0, "s")
      .show_default();
}

}  // namespace

void add_run_command(Command& program, Action& action) {
  const auto a = std::make_shared<RunArguments>();
  Command command = program.add_command("run", "Perform a task with a scripted operator and record it");
  a->the_case.task.clear();
  command.add_option("TASK,--task", a->the_case.task,
                     "Task: see trocar task list, or a task file (.toml); the patient's own when left out");
  command.add_option("--patient", a->source.folder_or_name,
                     "Patient folder, or name of an embedded patient; default of a replay: the session's patient");
  command
      .add_option("--operator", a->run.operator_name,
                  "expert, novice (each seed another one), novice:SHARE with the same share of all of the novice's "
                  "errors, from 0 "
                  "(none) to 1, constant-velocity:MM_PER_S or replay:SESSION")
      .required();
  command.add_option("--out", a->run.session, "Session file to write").required();
  command.add_option("--force-model", a->run.force_model,
                     "Force model: insertion (paper A), proxy (paper B) or combined; default: the task's model");
  command.add_option("--device", a->run.device, "Simulated device with its limits and coupling; see trocar device list")
      .show_default();
  command.add_option("--needle", a->the_case.needle, "Needle that the task allows; the task's own when left out");
  command.add_option("--posture", a->the_case.posture, kPostureHelp);
  command.add_option("--level", a->the_case.level,
                     "Level of difficulty of the task, by name or number; see trocar task list");
  add_breathing_options(command, a->the_case.breathing, a->the_case.held_phase);
  command.add_option("--tissues", a->the_case.tissue_file, "Tissue table (TOML) instead of data/tissues.toml");
  command.add_option("--profile", a->the_case.profile, "Profile of the tissue table: paper-a, tented ...");
  command
      .add_option("--set", a->the_case.overrides,
                  "Override numbers of the tissue table: liver.k=0.5, friction.grows_to=never")
      .one_value_each();
  command.add_option("--seed", a->run.seed, "Random seed for operator, friction and path choice").seed().show_default();
  command.add_option("--patient-seed", a->source.seed, "Random seed for the anatomy of an embedded patient")
      .seed()
      .show_default();
  command.add_option("--rate", a->run.rate_hz, "Haptic tick rate").number_within(250.0, 4000.0, "Hz").show_default();
  command.add_flag("--other-patient", a->run.is_other_patient_meant,
                   "Replay with a different patient than that of the session, given with --patient");
  add_cache_option(command, a->source);
  add_server_options(command, *a);
  command.add_option("--person", a->person, "Record the attempt for this person in the database of results");
  command.add_option("--db", a->database, "Database of --person; see trocar results --help");
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.footer(
      "Examples:\n  trocar run liver-biopsy --patient abdomen --operator expert --out first.session\n"
      "  trocar run liver-biopsy --patient my_patient --operator novice --set liver.k=0.5 --seed 4 --out "
      "second.session\n"
      "  trocar run liver-biopsy --patient biopsy-1 --operator novice --level hard --out hard.session\n"
      "  trocar run liver-biopsy --patient abdomen --operator novice:0.3 --seed 4 --out practised.session\n"
      "  trocar run --patient my_case --operator expert --out own_task.session\n"
      "  trocar run --operator replay:first.session --out again.session\n"
      "  trocar run liver-biopsy --patient abdomen --operator expert --realtime --out live.session\n"
      "  trocar run liver-biopsy --patient abdomen --operator expert --realtime --endpoint ipc:///tmp/needle "
      "--endpoint ipc:///tmp/probe --out live.session\n");
  command.when_parsed([&action, a, command] {
    a->named.note(command);
    action = [a] { return run_task(*a); };
  });
}

}  // namespace trocar::cli
