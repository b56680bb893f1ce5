// trocar session export, motion and report; metrics: metrics_command.cpp.
#include "cli/commands.h"

#include <fmt/format.h>

#include "attempt/live/attempt_view.h"
#include "attempt/record/session_case.h"
#include "cli/patient_option.h"
#include "cli/session/past_sessions.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "io/patient/patient_cache.h"
#include "report/html_report.h"
#include "storage/session_file.h"

namespace trocar::cli {
namespace {

/// Prints warnings about the session, except damage.
void warn_of(const storage::Session& session, const std::string& file) {
  if (session.is_incomplete)
    print_warning(fmt::format(
        "incomplete session: the program ended during the attempt; {} ticks were recorded and there is no score — {}",
        session.samples.size(), file));
  if (!session.has_checksums)
    print_warning(
        fmt::format("no checksums in a session of an older program: damage may remain undetected — {}", file));
  warn_of_forces(session.info, file);
}

Status export_session(const std::string& session_file, const std::string& csv) {
  TROCAR_TRY_STATUS(check_new(csv, "--csv"));
  TROCAR_TRY(const storage::Session session, storage::salvage_session(session_file));
  warn_of(session, session_file);
  TROCAR_TRY_STATUS(storage::export_csv(session, csv));
  if (session.damage.empty()) return {};
  return tl::unexpected(storage::damage_error(
      session, session_file,
      "the undamaged part was exported; after a gap the event column contains damaged:FIRST-LAST"));
}

Status write_session_motion(const std::string& session_file, const std::string& csv) {
  TROCAR_TRY_STATUS(check_new(csv, "--csv"));
  TROCAR_TRY(const storage::Session session, storage::load_session(session_file));
  warn_of_forces(session.info, session_file);
  TROCAR_TRY(const devices::RecordedMotion motion, attempt::stylus_motion(session));
  return devices::write_motion(motion, csv);
}

struct ReportArguments {
  std::string session;
  io::PatientSource patient;  ///< Empty: as recorded in the session.
  std::string out;
  std::string language = "en";
  bool is_text = false;
};

/// The session's patient; null with a warning if it is missing or has changed.
std::shared_ptr<const anatomy::VirtualPatient> find_report_patient(const storage::SessionInfo& info,
                                                                   io::PatientSource source,
                                                                   const std::filesystem::path& session,
                                                                   const Progress& progress) {
  if (source.folder_or_name.empty()) {
    auto found = io::find_recorded_patient(info.patient_source, info.patient_hash, session.parent_path());
    if (!found) {
      print_warning("the report has no CT slices and no steps: " + found.error().text());
      return nullptr;
    }
    source.folder_or_name = *std::move(found);
  }
  source.seed = info.patient_seed;
  auto patient = io::open_patient(source, progress);
  if (!patient) {
    print_warning("the report has no CT slices and no steps: " + patient.error().text());
    return nullptr;
  }
  if (patient->content_hash != info.patient_hash) {
    print_warning(fmt::format(
        "the report has no CT slices and no steps: the patient differs from that of the session — {} — name the right "
        "one with --patient",
        source.folder_or_name));
    return nullptr;
  }
  return std::make_shared<const anatomy::VirtualPatient>(*std::move(patient));
}

/// Steps and actions; what cannot be had is left out, steps with a warning.
report::ReportStory story_of(const storage::Session& session,
                             const std::shared_ptr<const anatomy::VirtualPatient>& patient, const std::string& file) {
  report::ReportStory story;
  if (const auto substances = tasks::load_substances(data_dir() / "substances.toml"))
    for (const attempt::AttemptEvent& action : attempt::describe_actions(*substances, session, patient.get()))
      story.actions.push_back({action.time_s, action.depth_mm, action.text});
  if (patient == nullptr) return story;
  const auto the_case = [&]() -> Result<cases::Case> {
    TROCAR_TRY(const auto parameters, attempt::replay_parameters(session, {}));
    return attempt::restore_case(patient, session, parameters.front());
  }();
  if (!the_case) {
    print_warning(fmt::format("the report has no steps: {} — {}", the_case.error().what, file));
    return story;
  }
  story.title = the_case->task.title;
  story.needs_image = the_case->task.guidance == tasks::ImagingModality::kUltrasound;
  story.steps = report::step_times(session, the_case->task, *patient, the_case->needle, the_case->plan);
  return story;
}

Status write_report(const ReportArguments& arguments) {
  if (arguments.is_text && !arguments.out.empty())
    return fail_usage("give --text or --out, not both", "--text, --out", "redirect the text to a file");
  if (arguments.is_text && arguments.language != "en")
    return fail_usage("the text report is English", "--text, --language", "leave out --text for the HTML report");
  TROCAR_TRY(const language::Language language, language::load_language(arguments.language));
  const std::filesystem::path out =
      arguments.out.empty() ? report::report_file_of(arguments.session) : std::filesystem::path(arguments.out);
  if (!arguments.is_text) TROCAR_TRY_STATUS(check_new(out));
  TROCAR_TRY(const storage::Session session, storage::salvage_session(arguments.session));
  warn_of(session, arguments.session);
  const ProgressPrinter printer;
  const auto patient = find_report_patient(session.info, arguments.patient, arguments.session, printer.callback());
  const report::ReportStory story = story_of(session, patient, arguments.session);
  if (arguments.is_text) {
    fmt::print("{}", report::text_report(session, story));
  } else {
    TROCAR_TRY_STATUS(write_file_atomically(out, report::html_report(session, patient.get(), story, language)));
    if (arguments.out.empty()) fmt::print("{}\n", out.string());
  }
  if (session.damage.empty()) return {};
  return tl::unexpected(storage::damage_error(session, arguments.session, "the report shows the undamaged part"));
}

}  // namespace

void add_session_commands(Command& program, Action& action) {
  Command session = program.add_command("session", "Recorded attempts");
  session.require_command();
  session.footer("Example:\n  trocar session report first.session --out first.html\n");

  struct ExportArguments {
    std::string session;
    std::string csv;
  };
  Command export_command = session.add_command("export", "Export as CSV, one row per tick");
  const auto e = std::make_shared<ExportArguments>();
  export_command.add_option("SESSION", e->session, "Session file of trocar run").required();
  export_command.add_option("--csv", e->csv, "CSV file to write").required();
  export_command.footer(
      "Units are mm, N, N mm, s; vectors are in the patient frame P (LPS).\n"
      "Example:\n  trocar session export first.session --csv first.csv\n");
  export_command.when_parsed([&action, e] { action = [e] { return export_session(e->session, e->csv); }; });

  Command motion_command =
      session.add_command("motion", "Write the stylus's motion as CSV, for trocar-hapticd --device replay:FILE");
  const auto m = std::make_shared<ExportArguments>();
  motion_command.add_option("SESSION", m->session, "Session file of trocar run").required();
  motion_command.add_option("--csv", m->csv, "CSV file to write").required();
  motion_command.footer(
      "One pose per tick: time (s), position of the grip (mm) and quaternion of the stylus, in the room: x towards the "
      "feet, y to the patient's left, z up.\n"
      "Example:\n  trocar session motion first.session --csv motion.csv\n  trocar-hapticd --device replay:motion.csv "
      "--tool needle --patient abdomen\n");
  motion_command.when_parsed([&action, m] { action = [m] { return write_session_motion(m->session, m->csv); }; });

  Command report_command = session.add_command(
      "report", "Write an HTML report: passed or not, what to improve, score, steps, forces and slices");
  const auto r = std::make_shared<ReportArguments>();
  report_command.add_option("SESSION", r->session, "Session file of trocar run").required();
  report_command.add_option("--patient", r->patient.folder_or_name, "Patient folder, if it was moved");
  add_cache_option(report_command, r->patient);
  report_command.add_option("--out", r->out,
                            "HTML file to write [beside the session: first.report.html of first.session]");
  report_command.add_option("--language", r->language, "Language of the HTML report: en, de [en]");
  report_command.add_flag("--text", r->is_text, "Print the report as text instead");
  report_command.footer(
      "Examples:\n  trocar session report first.session\n  trocar session report first.session --text\n  trocar "
      "session report first.session --out first.html --language de\n");
  report_command.when_parsed([&action, r] { action = [r] { return write_report(*r); }; });

  add_session_metrics_command(session, action);
}

}  // namespace trocar::cli
