// trocar plan: safe needle paths for a task.
#include <fmt/format.h>

#include <filesystem>

#include "cases/prepare_case.h"
#include "cli/commands.h"
#include "cli/constants.h"
#include "cli/json_parts.h"
#include "cli/patient_option.h"
#include "config/json.h"
#include "io/markups_file.h"
#include "io/patient/patient_cache.h"
#include "tasks/fit_to_patient.h"
#include "tasks/plan.h"

namespace trocar::cli {
namespace {
namespace fs = std::filesystem;

struct PlanArguments {
  std::string task;
  io::PatientSource source;
  std::string needle, posture;
  tasks::PlanOptions options;
  std::string out;
  bool is_json = false;
};

void print_plan(const std::vector<tasks::PlannedPath>& paths, bool is_json) {
  if (is_json) {
    config::Json list = config::Json::array();
    for (const tasks::PlannedPath& p : paths) {
      list.push_back({{"entry_mm", vector_json(p.line_P.a)},
                      {"target_mm", vector_json(p.line_P.b)},
                      {"length_mm", p.length_mm},
                      {"organ_path_mm", p.organ_path_mm},
                      {"spare_margin_mm", p.spare_margin_mm},
                      {"nearest_risk", p.nearest_risk},
                      {"posture", std::string(anatomy::posture_name(p.posture))},
                      {"cost_mm", p.cost_mm}});
    }
    print_json({{"paths", list}});
    return;
  }
  fmt::print("with the patient {}\n", anatomy::posture_words(paths.front().posture));
  fmt::print("{:>4} {:>10} {:>14} {:>14}  {}\n", "path", "length", "in the organ", "spare margin", "nearest risk");
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const tasks::PlannedPath& p = paths[i];
    fmt::print("{:>4} {:>7.1f} mm {:>11.1f} mm {:>11.1f} mm  {}\n", i + 1, p.length_mm, p.organ_path_mm,
               p.spare_margin_mm, p.nearest_risk);
  }
}

Status plan(const PlanArguments& arguments) {
  TROCAR_TRY_STATUS(check_new(arguments.out));
  cases::CaseOptions options;
  options.task = arguments.task;
  options.needle = arguments.needle;
  options.posture = arguments.posture;
  options.patient_folder = arguments.source.folder_or_name;
  TROCAR_TRY(const cases::Case tables, cases::load_tables(options));
  std::vector<tasks::PlannedPath> paths;
  {
    const ProgressPrinter printer;
    TROCAR_TRY(const anatomy::VirtualPatient patient, io::open_patient(arguments.source, printer.callback()));
    const tasks::Task task = tasks::fit_to_patient(tables.task, patient);
    TROCAR_TRY(paths, tasks::plan_paths(task, patient, tables.needle, arguments.options, printer.callback()));
  }
  std::vector<anatomy::NeedlePath> named;
  for (const tasks::PlannedPath& p : paths)
    named.push_back({fmt::format("{}-{}", tables.task.name, named.size() + 1), p.line_P});
  TROCAR_TRY_STATUS(io::write_paths(named, arguments.out));
  print_plan(paths, arguments.is_json);
  return {};
}

}  // namespace

void add_plan_command(Command& program, Action& action) {
  const auto a = std::make_shared<PlanArguments>();
  Command command = program.add_command("plan", "Plan safe needle paths that keep all margins of the task");
  command.add_option("TASK,--task", a->task,
                     "Task: see trocar task list, or a task file (.toml); default: the patient's own task");
  command.add_option("--patient", a->source.folder_or_name, "Patient folder, or an embedded patient's name").required();
  command.add_option("--count", a->options.count, "Number of paths, each with a different entry point")
      .whole_number_within(1, 100000)
      .show_default();
  command.add_option("--needle", a->needle, "Needle of data/needles.toml; default: the task's needle");
  command.add_option("--posture", a->posture, kPostureHelp);
  command.add_option("--seed", a->options.seed, "Random seed for the choice among paths").seed().show_default();
  command.add_option("--patient-seed", a->source.seed, "Random seed for the anatomy of an embedded patient")
      .seed()
      .show_default();
  add_cache_option(command, a->source);
  command.add_option("--out", a->out, "3D Slicer markups file to write (.mrk.json)").required();
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.footer("Example:\n  trocar plan liver-biopsy --patient abdomen --count 5 --out paths.mrk.json\n");
  command.when_parsed([&action, a] { action = [a] { return plan(*a); }; });
}

}  // namespace trocar::cli
