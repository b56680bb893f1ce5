// trocar session metrics.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "cases/imaging.h"
#include "cli/commands.h"
#include "cli/patient_option.h"
#include "cli/session/past_sessions.h"
#include "config/json.h"
#include "core/files/input_file.h"
#include "io/markups_file.h"
#include "io/patient/patient_cache.h"
#include "metrics/measure_run.h"
#include "metrics/pose_csv.h"
#include "storage/session_moments.h"
#include "tasks/fit_to_patient.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::cli {
namespace {

constexpr const char* kTransducer = "C5-2";  // of the trainer's tasks

struct MetricsArguments {
  std::string recording;
  std::string task, expert, needle;
  std::string transducer = kTransducer;
  double depth_mm = 0.0;  ///< 0: the transducer's default.
  io::PatientSource patient;
  bool is_json = false;
};

/// Owner of the data that a context points at, with the context.
struct MeasuredCase {
  std::optional<tasks::Task> task;
  std::optional<anatomy::VirtualPatient> patient;
  metrics::MetricContext context;
  Status damage;  ///< Error of a session of which only a part could be read.
};

bool is_database(const std::string& file) {
  const auto input = InputFile::open(file, FileKind::kSession);  // a pipe would block
  if (!input) return false;
  std::string head(15, '\0');
  std::ifstream(input->pinned_path(), std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head == "SQLite format 3";
}

Result<metrics::ImagePlane> load_plane(const MetricsArguments& arguments) {
  TROCAR_TRY(const auto file, find_data("transducers.toml"));
  TROCAR_TRY(const ultrasound::Transducer transducer, ultrasound::load_transducer(file, arguments.transducer));
  return cases::image_plane(transducer, arguments.depth_mm > 0.0 ? arguments.depth_mm : transducer.depth_mm);
}

/// The task named by the user: one of the data folder, or a file.
Result<tasks::Task> load_named_task(const std::string& name) {
  TROCAR_TRY(const auto folder, find_data("tasks"));
  if (name.ends_with(".toml")) return tasks::load_task_file(name, folder);
  return tasks::load_task(folder, name);
}

Result<tasks::Task> recorded_task(const storage::SessionInfo& info) {
  TROCAR_TRY(const auto folder, find_data("tasks"));
  if (info.task_toml.empty()) return tasks::load_task(folder, info.task);
  return tasks::parse_task(info.task_toml, info.task, "the session's task", folder);
}

/// The patient of a session. Errors: it is not found, cannot be read or is another one.
Result<anatomy::VirtualPatient> open_recorded_patient(const storage::SessionInfo& info,
                                                      const MetricsArguments& arguments, const Progress& progress) {
  io::PatientSource source = arguments.patient;
  if (source.folder_or_name.empty()) {
    const std::filesystem::path beside = std::filesystem::path(arguments.recording).parent_path();
    TROCAR_TRY(source.folder_or_name, io::find_recorded_patient(info.patient_source, info.patient_hash, beside));
  }
  source.seed = info.patient_seed;
  TROCAR_TRY(anatomy::VirtualPatient patient, io::open_patient(source, progress));
  if (patient.content_hash != info.patient_hash)
    return fail("is not the patient of the session", source.folder_or_name, "name the right one with --patient");
  return patient;
}

/// A patient that the user named must be the right one; without another one there are fewer metrics and a warning.
Status find_patient(const storage::SessionInfo& info, const MetricsArguments& arguments, MeasuredCase& measured) {
  const ProgressPrinter printer;
  auto patient = open_recorded_patient(info, arguments, printer.callback());
  if (patient) {
    measured.patient = *std::move(patient);
  } else if (!arguments.patient.folder_or_name.empty()) {
    return tl::unexpected(std::move(patient).error());
  } else {
    print_warning("metrics that need the patient have no value: " + patient.error().text());
  }
  return {};
}

/// The needle of a session.
Result<tasks::Needle> recorded_needle(const storage::SessionInfo& info, const MetricsArguments& arguments) {
  TROCAR_TRY(const auto file, find_data("needles.toml"));
  TROCAR_TRY(const std::vector<tasks::Needle> needles, tasks::load_needles(file));
  const auto found = std::ranges::find(needles, info.needle, &tasks::Needle::name);
  if (found == needles.end())
    return fail(fmt::format("the needle \"{}\" of the session is not in the list", info.needle), arguments.recording,
                "name a needle with --needle");
  return *found;
}

/// The patient's own expert paths for the task, behind those that are there. A biopsy needle is fired before the end of
/// such a path, so that it has none.
void add_own_paths(MeasuredCase& measured) {
  if (!measured.patient || !measured.task || (measured.context.needle && measured.context.needle->is_biopsy)) return;
  for (const anatomy::NeedlePath& path : measured.patient->paths)
    if (tasks::is_path_for(*measured.task, path)) measured.context.expert_paths.push_back({path.name, path.line_P});
}

Status replace_experts(const std::string& file, metrics::MetricContext& context) {
  if (file.empty()) return {};
  TROCAR_TRY(const std::vector<anatomy::NeedlePath> paths, io::read_paths(file));
  context.expert_paths.clear();
  for (const anatomy::NeedlePath& path : paths) context.expert_paths.push_back({path.name, path.line_P});
  return {};
}

/// Adds what the arguments name and what is found in the data folder to a context.
Status complete(const MetricsArguments& arguments, MeasuredCase& measured) {
  if (!arguments.task.empty()) {
    TROCAR_TRY(measured.task, load_named_task(arguments.task));
  }
  if (!arguments.needle.empty() || (measured.task && !measured.context.needle)) {
    TROCAR_TRY(const auto needles, find_data("needles.toml"));
    TROCAR_TRY(measured.context.needle,
               tasks::load_needle(needles, arguments.needle.empty() ? measured.task->needle : arguments.needle));
  }
  if (measured.task && measured.patient)
    measured.task = tasks::fit_to_patient(*std::move(measured.task), *measured.patient);
  add_own_paths(measured);
  TROCAR_TRY_STATUS(replace_experts(arguments.expert, measured.context));
  const bool names_another = arguments.transducer != kTransducer || arguments.depth_mm > 0.0;
  if (!measured.context.plane || names_another) {
    TROCAR_TRY(measured.context.plane, load_plane(arguments));
  }
  measured.context.task = measured.task ? &*measured.task : nullptr;
  measured.context.patient = measured.patient ? &*measured.patient : nullptr;
  return {};
}

Result<std::vector<metrics::MetricValue>> measure_session(const MetricsArguments& arguments, MeasuredCase& measured) {
  TROCAR_TRY(const storage::Session session, storage::salvage_session(arguments.recording));
  if (session.is_incomplete)
    print_warning(fmt::format("incomplete session: the program ended during the attempt; {} ticks are measured — {}",
                              session.samples.size(), arguments.recording));
  warn_of_forces(session.info, arguments.recording);
  if (!session.damage.empty())
    measured.damage = tl::unexpected(
        storage::damage_error(session, arguments.recording, "the metrics are those of the undamaged part"));
  measured.context = storage::context_of(session);
  if (arguments.task.empty()) {
    TROCAR_TRY(measured.task, recorded_task(session.info));
  }
  if (arguments.needle.empty()) {
    TROCAR_TRY(measured.context.needle, recorded_needle(session.info, arguments));
  }
  TROCAR_TRY_STATUS(find_patient(session.info, arguments, measured));
  TROCAR_TRY_STATUS(complete(arguments, measured));
  const auto& needle = measured.context.needle;
  const bool is_biopsy = needle ? needle->is_biopsy : !session.shots.empty();
  measured.context.end_s = storage::end_s_of(session, measured.context.task, is_biopsy);
  metrics::MeasureRun run(measured.context);
  storage::walk_moments(session, [&](const metrics::Moment& moment) { run.step(moment); });
  return run.report();
}

Result<std::vector<metrics::MetricValue>> measure_poses(const MetricsArguments& arguments, MeasuredCase& measured) {
  TROCAR_TRY(const metrics::PoseTable table, metrics::PoseTable::read(arguments.recording));
  if (!arguments.patient.folder_or_name.empty()) {
    const ProgressPrinter printer;
    TROCAR_TRY(measured.patient, io::open_patient(arguments.patient, printer.callback()));
  }
  measured.context.layer_names = table.layer_names();
  TROCAR_TRY_STATUS(complete(arguments, measured));
  metrics::MeasureRun run(measured.context);
  table.walk([&](const metrics::Moment& moment) { run.step(moment); });
  if (run.left_out() == table.rows())
    return fail(fmt::format("none of the {} rows has a time, a position and a direction", table.rows()),
                arguments.recording, "docs/metrics.md describes the columns");
  if (run.left_out() > 0)
    print_warning(fmt::format("{} of {} rows are left out: they are not finite, or not later than the row above — {}",
                              run.left_out(), table.rows(), arguments.recording));
  return run.report();
}

const char* word_of(metrics::Better better) {
  switch (better) {
    case metrics::Better::kLower:
      return "lower";
    case metrics::Better::kHigher:
      return "higher";
    case metrics::Better::kNeither:
      return "neither";
  }
  return "";
}

void print_as_json(const std::vector<metrics::MetricValue>& values, const MeasuredCase& measured,
                   const MetricsArguments& arguments) {
  const std::vector<metrics::MetricDescription> catalogue = metrics::metric_catalogue();
  config::Json list = config::Json::array();
  for (std::size_t n = 0; n < values.size(); ++n) {
    const metrics::MetricValue& value = values[n];
    config::Json row{{"name", value.name},
                     {"title", catalogue[n].title},
                     {"value", value.value ? config::Json(*value.value) : config::Json()},
                     {"unit", value.unit},
                     {"better", word_of(catalogue[n].better)}};
    if (!value.missing.empty()) row["missing"] = value.missing;
    if (!value.note.empty()) row["note"] = value.note;
    if (value.at_s) row["at_s"] = *value.at_s;
    list.push_back(std::move(row));
  }
  print_json({{"recording", arguments.recording},
              {"task", measured.task ? config::Json(measured.task->name) : config::Json()},
              {"patient", measured.patient ? config::Json(measured.patient->name) : config::Json()},
              {"metrics", list}});
}

/// Numbers as people read them: counts whole, others with three decimals; large ones by their exponent.
std::string number_text(double value) {
  if (value == std::round(value) && std::abs(value) < 1e6) return fmt::format("{:.0f}", value);
  return std::abs(value) < 1e5 ? fmt::format("{:.3f}", value) : fmt::format("{:.4g}", value);
}

void print_as_text(const std::vector<metrics::MetricValue>& values) {
  const std::vector<metrics::MetricDescription> catalogue = metrics::metric_catalogue();
  for (std::size_t n = 0; n < values.size(); ++n) {
    const metrics::MetricValue& value = values[n];
    if (!value.value) {
      fmt::print("{:<24} {:>12}        {}: {}\n", value.name, "-", catalogue[n].title, value.missing);
      continue;
    }
    const std::string note = value.note.empty() ? std::string() : fmt::format(" ({})", value.note);
    fmt::print("{:<24} {:>12} {:<6} {}{}\n", value.name, number_text(*value.value), value.unit == "1" ? "" : value.unit,
               catalogue[n].title, note);
  }
}

Status print_metrics(const MetricsArguments& arguments) {
  MeasuredCase measured;
  TROCAR_TRY(const std::vector<metrics::MetricValue> values, is_database(arguments.recording)
                                                                 ? measure_session(arguments, measured)
                                                                 : measure_poses(arguments, measured));
  if (arguments.is_json)
    print_as_json(values, measured, arguments);
  else
    print_as_text(values);
  return measured.damage;
}

}  // namespace

void add_session_metrics_command(Command& session, Action& action) {
  Command command = session.add_command("metrics", "Measure a session, or poses of another system as CSV");
  const auto a = std::make_shared<MetricsArguments>();
  command.add_option("RECORDING", a->recording, "Session file of trocar run, or a CSV file of poses").required();
  command.add_option("--task", a->task, "Task, or a file TASK.toml; default: that of the session");
  command.add_option("--patient", a->patient.folder_or_name,
                     "Patient folder or embedded patient; default: that of the session");
  command.add_option("--seed", a->patient.seed, "Seed of an embedded patient, for a CSV file").seed();
  add_cache_option(command, a->patient);
  command.add_option("--expert", a->expert,
                     "Expert paths (.mrk.json); default: the session's plan and the patient's paths");
  command.add_option("--needle", a->needle, "Needle; default: that of the session, or of the task");
  command.add_option("--transducer", a->transducer, "Transducer, for its image plane").show_default();
  command.add_option("--depth", a->depth_mm, "Depth of the image [the transducer's]").number_within(10, 400, "mm");
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.footer(
      "A metric without a value is printed with the reason. Definitions and the columns of the CSV file: "
      "docs/metrics.md.\n"
      "Examples:\n  trocar session metrics first.session\n  trocar session metrics poses.csv --task liver-biopsy "
      "--patient abdomen --expert paths.mrk.json --json\n");
  command.when_parsed([&action, a] { action = [a] { return print_metrics(*a); }; });
}

}  // namespace trocar::cli
