// trocar run: an attempt by a scripted operator.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "commands.h"
#include "headless/run_session.h"
#include "io/patient_source.h"

namespace trocar::cli {
namespace {

struct Arguments {
  CaseOptions the_case;
  RunOptions run;
  PatientSource source;
  bool is_json = false;
};

Json core_json(const BiopsyCore& core) {
  Json pieces = Json::array();
  for (const CorePiece& piece : core.pieces) {
    pieces.push_back(
        {{"label", piece.label}, {"tissue", piece.tissue}, {"from_mm", piece.from_mm}, {"to_mm", piece.to_mm}});
  }
  return {{"target_mm", core.target_mm},           {"organ_mm", core.organ_mm},
          {"vessel_mm", core.vessel_mm},           {"other_mm", core.other_mm},
          {"risks_in_throw", core.risks_in_throw}, {"pieces", pieces}};
}

Json result_json(const Arguments& arguments, const Case& the_case, const RunResult& result) {
  const Outcome& outcome = result.outcome;
  Json parts = Json::array();
  for (const ScorePart& part : outcome.parts) {
    parts.push_back({{"name", part.name},
                     {"title", part.title},
                     {"value", part.value},
                     {"unit", part.unit},
                     {"points", part.points},
                     {"max_points", part.max_points}});
  }
  Json punctures = Json::array();
  for (const PunctureRecord& puncture : result.punctures) {
    punctures.push_back({{"layer", puncture.layer},
                         {"time_s", puncture.time_s},
                         {"depth_mm", puncture.depth_mm},
                         {"peak_n", puncture.peak_n}});
  }
  return {{"session", arguments.run.session.string()},
          {"task", the_case.task.name},
          {"patient", the_case.patient->name},
          {"operator", arguments.run.operator_name},
          {"device", arguments.run.device},
          {"parenchymal", the_case.is_parenchymal},
          {"simulated_s", result.simulated_s},
          {"ticks", result.ticks},
          {"score", outcome.score},
          {"target_reached", outcome.target_reached},
          {"parts", parts},
          {"punctures", punctures},
          {"risks_touched", outcome.risks_touched},
          {"core", outcome.core ? core_json(*outcome.core) : Json(nullptr)},
          {"hints", outcome.hints}};
}

void print_result(const Arguments& arguments, const Case& the_case, const RunResult& result) {
  const Outcome& outcome = result.outcome;
  fmt::print("{} on {} by {}: {:.1f} s, {} ticks\n", the_case.task.title, the_case.patient->name,
             arguments.run.operator_name, result.simulated_s, result.ticks);
  if (the_case.is_parenchymal) fmt::print("no lesion in this patient: the target lies in healthy tissue\n");
  for (const PunctureRecord& p : result.punctures) {
    fmt::print("  puncture of {:<16} at {:6.2f} s, {:5.1f} mm deep, {:.2f} N\n", p.layer, p.time_s, p.depth_mm,
               p.peak_n);
  }
  if (outcome.core) {
    const BiopsyCore& core = *outcome.core;
    fmt::print("  core: {:.1f} mm target, {:.1f} mm organ, {:.1f} mm vessel, {:.1f} mm other\n", core.target_mm,
               core.organ_mm, core.vessel_mm, core.other_mm);
  }
  fmt::print("score {:.0f} of 100, target {}\n", outcome.score, outcome.target_reached ? "reached" : "missed");
  for (const ScorePart& part : outcome.parts) {
    fmt::print("  {:<44} {:>8.2f} {:<4} {:>6.1f} of {:.0f} points\n", part.title, part.value, part.unit, part.points,
               part.max_points);
  }
  for (const std::string& hint : outcome.hints) fmt::print("hint: {}\n", hint);
}

Status run(Arguments& arguments) {
  RunOptions& run = arguments.run;
  TROCAR_TRY_STATUS(check_new(run.session));
  run.patient_source = arguments.source.folder_or_name;
  run.patient_seed = arguments.source.seed;
  run.seed = arguments.source.seed;
  arguments.the_case.seed = arguments.source.seed;
  TROCAR_TRY_STATUS(check_run(run));
  TROCAR_TRY_STATUS(load_tables(arguments.the_case));
  Case the_case;
  RunResult result;
  {
    const ProgressPrinter printer;
    TROCAR_TRY(VirtualPatient patient, open_patient(arguments.source, printer.callback()));
    TROCAR_TRY(the_case, prepare_case(std::make_shared<const VirtualPatient>(std::move(patient)), arguments.the_case,
                                      printer.callback()));
    TROCAR_TRY(result, run_session(the_case, run, printer.callback()));
  }
  if (arguments.is_json) {
    print_json(result_json(arguments, the_case, result));
  } else {
    print_result(arguments, the_case, result);
  }
  return {};
}

}  // namespace

void add_run_command(CLI::App& program, Action& action) {
  const auto a = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand("run", "Perform a task with a scripted operator and record it");
  command->add_option("TASK", a->the_case.task, "Task: see trocar task list")->required();
  command->add_option("--patient", a->source.folder_or_name, "Patient folder, or an embedded patient's name")
      ->required();
  command
      ->add_option("--operator", a->run.operator_name, "expert, novice, constant-velocity:MM_PER_S or replay:SESSION")
      ->required();
  command->add_option("--out", a->run.session, "Session file to write")->required();
  command->add_option(
      "--force-model", a->run.force_model,
      "How forces are made: insertion (paper A), proxy (paper B) or combined; the task's own when left out");
  command->add_option("--device", a->run.device, "Simulated device: its limits and coupling; see trocar device list")
      ->capture_default_str();
  command->add_option("--needle", a->the_case.needle, "Needle of data/needles.toml; the task's own when left out");
  command->add_option("--tissues", a->the_case.tissue_file, "Tissue table (TOML) instead of data/tissues.toml");
  command->add_option("--profile", a->the_case.profile, "Profile of the tissue table: paper-a, tented ...");
  command->add_option("--set", a->the_case.overrides, "Change numbers of the tissue table: liver.k=0.5")
      ->allow_extra_args(false);
  command->add_option("--seed", a->source.seed, "Of operator, friction, plan and embedded patient")
      ->capture_default_str();
  command->add_option("--rate", a->run.rate_hz, "Ticks a second, in Hz, 250 to 4000")->capture_default_str();
  command->add_flag("--json", a->is_json, "Print one JSON object");
  command->footer(
      "Examples:\n  trocar run liver-biopsy --patient abdomen --operator expert --out first.session\n"
      "  trocar run liver-biopsy --patient my_patient --operator novice --set liver.k=0.5 --seed 4 --out "
      "second.session\n");
  command->callback([&action, a] { action = [a] { return run(*a); }; });
}

}  // namespace trocar::cli
