// trocar session export and report.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "commands.h"
#include "core/atomic_file.h"
#include "io/patient_source.h"
#include "report/html_report.h"
#include "storage/session_file.h"

namespace trocar::cli {
namespace {

Status export_session(const std::string& session_file, const std::string& csv) {
  TROCAR_TRY_STATUS(check_new(csv));
  TROCAR_TRY(const Session session, load_session(session_file));
  return export_csv(session, csv);
}

struct ReportArguments {
  std::string session;
  std::string patient;  ///< Empty: where the session says.
  std::string out;
};

/// The session's patient, or nothing with a warning where it is gone or has changed since.
std::optional<VirtualPatient> find_patient(const SessionInfo& info, const std::string& wanted,
                                           const Progress& progress) {
  const std::string where = wanted.empty() ? info.patient_source : wanted;
  auto patient = open_patient({where, info.patient_seed}, progress);
  if (!patient) {
    print_warning(
        fmt::format("the report has no CT slices — {} — name the patient with --patient", patient.error().text()));
    return std::nullopt;
  }
  if (patient->content_hash != info.patient_hash) {
    print_warning(
        fmt::format("the report has no CT slices — {} is not the patient of the session — name it with "
                    "--patient",
                    where));
    return std::nullopt;
  }
  return *std::move(patient);
}

Status write_report(const ReportArguments& arguments) {
  TROCAR_TRY_STATUS(check_new(arguments.out));
  TROCAR_TRY(const Session session, load_session(arguments.session));
  const ProgressPrinter printer;
  const auto patient = find_patient(session.info, arguments.patient, printer.callback());
  return write_file_atomically(arguments.out, html_report(session, patient ? &*patient : nullptr));
}

}  // namespace

void add_session_commands(CLI::App& program, Action& action) {
  CLI::App* session = program.add_subcommand("session", "Recorded attempts");
  session->require_subcommand(1);
  session->footer("Example:\n  trocar session report first.session --out first.html\n");

  struct ExportArguments {
    std::string session;
    std::string csv;
  };
  CLI::App* export_command = session->add_subcommand("export", "Write one row a haptic tick");
  const auto e = std::make_shared<ExportArguments>();
  export_command->add_option("SESSION", e->session, "Session file of trocar run")->required();
  export_command->add_option("--csv", e->csv, "CSV file to write")->required();
  export_command->footer(
      "Units are mm, N, N mm, s; vectors are in the patient frame P (LPS).\n"
      "Example:\n  trocar session export first.session --csv first.csv\n");
  export_command->callback([&action, e] { action = [e] { return export_session(e->session, e->csv); }; });

  CLI::App* report_command = session->add_subcommand("report", "Write a page with score, hints, forces and slices");
  const auto r = std::make_shared<ReportArguments>();
  report_command->add_option("SESSION", r->session, "Session file of trocar run")->required();
  report_command->add_option("--patient", r->patient, "Where the patient lies now, if it was moved");
  report_command->add_option("--out", r->out, "HTML file to write")->required();
  report_command->footer("Example:\n  trocar session report first.session --out first.html\n");
  report_command->callback([&action, r] { action = [r] { return write_report(*r); }; });
}

}  // namespace trocar::cli
