// trocar patient fetch: series of a PACS.
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "cli/commands.h"
#include "cli/json_parts.h"
#include "config/json.h"
#include "core/files/input_file.h"
#include "core/interruption.h"
#include "dicom/pacs/dicomweb_source.h"
#include "dicom/pacs/dimse_source.h"
#include "dicom/pacs/fetch_study.h"

namespace trocar::cli {
namespace {
namespace fs = std::filesystem;

constexpr const char* kPasswordVariable = "TROCAR_PACS_PASSWORD";

struct FetchArguments {
  std::string pacs, dicomweb;
  std::string study, patient_id;
  std::vector<std::string> series;
  std::string out;
  std::string title = "TROCAR";
  std::string via = "move";
  std::string user, password_file;
  int listen_port = dicom::DimseOptions().listen_port;
  int timeout_s = dicom::DimseOptions().timeout_s;
  bool keeps_identity = false;
  bool is_list = false;
  bool is_json = false;
};

/// From the file, the environment or the terminal: a command line can be read by other users.
Result<std::string> read_password(const FetchArguments& arguments) {
  if (!arguments.password_file.empty()) {
    TROCAR_TRY(const std::string text, read_input(arguments.password_file, FileKind::kOther));
    return text.substr(0, text.find_first_of("\r\n"));
  }
  if (const char* password = std::getenv(kPasswordVariable)) return password;
  if (::isatty(STDIN_FILENO) == 1)
    if (const char* password = ::getpass("Password: ")) return password;
  return fail_usage("no password", "--user",
                    fmt::format("name a file with --password-file, or set {}", kPasswordVariable));
}

Result<std::unique_ptr<dicom::PacsSource>> open_source(const FetchArguments& arguments) {
  if (arguments.pacs.empty() == arguments.dicomweb.empty())
    return fail_usage("which PACS?", "--pacs, --dicomweb", "give one of the two");
  if (!arguments.pacs.empty()) {
    TROCAR_TRY(dicom::DimseOptions options, dicom::parse_pacs_address(arguments.pacs));
    TROCAR_TRY_STATUS(dicom::check_ae_title(arguments.title, "--aet"));
    options.calling_title = arguments.title;
    options.listen_port = arguments.listen_port;
    options.timeout_s = arguments.timeout_s;
    options.uses_get = arguments.via == "get";
    return dicom::make_dimse_source(std::move(options));
  }
  TROCAR_TRY(dicom::DicomWebOptions options, dicom::parse_dicomweb_url(arguments.dicomweb));
  options.timeout_s = arguments.timeout_s;
  options.user = arguments.user;
  if (!options.user.empty()) {
    TROCAR_TRY(options.password, read_password(arguments));
    if (!options.is_secure) print_warning("the password is sent without encryption: use https if the server permits");
  }
  return dicom::make_dicomweb_source(std::move(options));
}

Status list_studies(dicom::PacsSource& source, const FetchArguments& arguments) {
  TROCAR_TRY(const auto studies, source.list_studies(arguments.patient_id));
  if (studies.empty())
    return fail("the PACS has no study of this patient", arguments.patient_id, "check the patient ID");
  config::Json list = config::Json::array();
  if (!arguments.is_json) fmt::print("{:<8}  {:<12} {:<32} {}\n", "date", "modalities", "description", "UID");
  for (const dicom::StudyEntry& study : studies) {
    if (!arguments.is_json)
      fmt::print("{:<8}  {:<12} {:<32} {}\n", study.date, study.modalities, study.description, study.uid);
    list.push_back({{"uid", study.uid},
                    {"date", study.date},
                    {"description", study.description},
                    {"modalities", study.modalities}});
  }
  if (arguments.is_json) print_json({{"studies", list}});
  return {};
}

/// The same table as `trocar patient series`.
Status list_pacs_series(dicom::PacsSource& source, const FetchArguments& arguments) {
  TROCAR_TRY(const auto series, dicom::list_study(source, arguments.study));
  config::Json list = config::Json::array();
  if (!arguments.is_json)
    fmt::print("{:>6} {:<8} {:>6}  {:<32} {}\n", "number", "modality", "images", "description", "UID");
  for (std::size_t n = 0; n < series.size(); ++n) {
    const dicom::SeriesEntry& s = series[n];
    if (!arguments.is_json)
      fmt::print("{:>6} {:<8} {:>6}  {:<32} {}\n", n + 1, s.modality, s.images ? std::to_string(*s.images) : "?",
                 s.description, s.uid);
    list.push_back({{"number", n + 1},
                    {"uid", s.uid},
                    {"description", s.description},
                    {"modality", s.modality},
                    {"images", or_null(s.images)}});
  }
  if (arguments.is_json) print_json({{"series", list}});
  return {};
}

config::Json to_json(const dicom::FetchedStudy& fetched, const FetchArguments& arguments, double seconds) {
  config::Json series = config::Json::array();
  for (const dicom::FetchedSeries& s : fetched.series)
    series.push_back({{"number", s.number},
                      {"uid", s.uid},
                      {"modality", s.modality},
                      {"images", s.images},
                      {"folder", (fs::path(arguments.out) / s.folder).string()}});
  return {{"folder", arguments.out},
          {"anonymised", !arguments.keeps_identity},
          {"seconds", seconds},
          {"series", series},
          {"warnings", fetched.warnings}};
}

void print_fetched(const dicom::FetchedStudy& fetched, const FetchArguments& arguments, double seconds) {
  std::size_t images = 0;
  for (const dicom::FetchedSeries& s : fetched.series) images += s.images;
  fmt::print("{} {} of {} series in {:.1f} s, {}\n", images, images == 1 ? "image" : "images", fetched.series.size(),
             seconds, arguments.keeps_identity ? "with the identity of the patient" : "anonymised");
  for (const dicom::FetchedSeries& s : fetched.series)
    fmt::print("{:>6} {:<8} {:>6}  {}\n", s.number, s.modality, s.images,
               (fs::path(arguments.out) / s.folder).string());
}

Status fetch_series(dicom::PacsSource& source, const FetchArguments& arguments) {
  if (arguments.out.empty())
    return fail_usage("--out is missing", "--out", "name a folder to create, or only list the series with --list");
  TROCAR_TRY_STATUS(check_new(arguments.out));
  if (arguments.keeps_identity)
    print_warning("the files will contain name and data of the patient: keep them where such data are allowed");
  const InterruptibleWork interruptible;
  const auto start = std::chrono::steady_clock::now();
  dicom::FetchOptions options;
  options.study_uid = arguments.study;
  options.series = arguments.series;
  options.keeps_identity = arguments.keeps_identity;
  options.is_cancelled = [] { return is_interrupted(); };
  dicom::FetchedStudy fetched;
  {
    const ProgressPrinter printer;
    auto result = dicom::fetch_study(source, options, arguments.out, printer.callback());
    if (!result && is_interrupted()) return tl::unexpected(interruption_error(arguments.out));
    TROCAR_TRY(fetched, std::move(result));
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const std::string& warning : fetched.warnings) print_warning(warning);
  if (arguments.is_json) {
    print_json(to_json(fetched, arguments, seconds));
  } else {
    print_fetched(fetched, arguments, seconds);
  }
  return {};
}

Status fetch(const FetchArguments& arguments) {
  if (arguments.study.empty() == arguments.patient_id.empty())
    return fail_usage("which study?", "--study, --patient-id",
                      "name the study by its UID; --patient-id lists the studies of a patient");
  if (!arguments.patient_id.empty() && !arguments.out.empty())
    return fail_usage("--patient-id only lists studies", "--out", "choose one of them with --study");
  TROCAR_TRY(const std::unique_ptr<dicom::PacsSource> source, open_source(arguments));
  if (!arguments.patient_id.empty()) return list_studies(*source, arguments);
  return arguments.is_list ? list_pacs_series(*source, arguments) : fetch_series(*source, arguments);
}

void add_pacs_options(Command& command, FetchArguments& a) {
  command.add_option("--pacs", a.pacs, "PACS with DICOM's own protocol: AET@HOST:PORT");
  command.add_option("--dicomweb", a.dicomweb, "PACS with DICOMweb: http(s)://HOST:PORT/PATH");
  command.add_option("--aet", a.title, "Our AE title, as the PACS has to know it").show_default();
  command.add_option("--listen-port", a.listen_port, "Port that the PACS sends to (C-MOVE)")
      .whole_number_within(1, 65535)
      .show_default();
  command.add_option("--via", a.via, "With --pacs: move (C-MOVE) or get (C-GET, needs no entry of our port)")
      .one_of({"move", "get"})
      .show_default();
  command.add_option("--user", a.user,
                     fmt::format("With --dicomweb: user; the password is read from --password-file, from the variable "
                                 "{} or from the terminal",
                                 kPasswordVariable));
  command.add_option("--password-file", a.password_file, "File whose first line is the password");
  command.add_option("--timeout", a.timeout_s, "Longest time without data (s)")
      .whole_number_within(1, 3600)
      .show_default();
}

}  // namespace

void add_patient_fetch_command(Command& patient, Action& action) {
  Command command = patient.add_command("fetch", "Fetch series from a PACS, anonymised");
  command.footer(
      "Names, numbers, dates, private elements and all other elements that Trocar does not need are removed, UIDs are\n"
      "replaced. Texts with words that are not in data/harmless_words.toml are replaced by codes. Segmentations and\n"
      "structure sets fetched by one command still fit their CT. Pixels are not changed: a warning names series that\n"
      "may show text.\n"
      "Examples:\n  trocar patient fetch --pacs ORTHANC@192.168.1.5:4242 --study 1.2.840.1 --list\n"
      "  trocar patient fetch --pacs ORTHANC@192.168.1.5:4242 --study 1.2.840.1 --series 2 --series 4 --out dicom_1\n"
      "  trocar patient fetch --dicomweb https://pacs.example/dicom-web --user me --study 1.2.840.1 --out dicom_1\n"
      "  trocar patient build --ct dicom_1 --labels segmentation.nii.gz --out case_1\n");
  const auto a = std::make_shared<FetchArguments>();
  add_pacs_options(command, *a);
  command.add_option("--study", a->study, "UID of the study");
  command.add_option("--patient-id", a->patient_id, "List the studies of this patient");
  command.add_option("--series", a->series,
                     "Number or UID of a series, see --list; can be repeated. Default: all series with images, "
                     "segmentations or structure sets");
  command.add_flag("--list", a->is_list, "List the series of the study and fetch nothing");
  command.add_option("--out", a->out, "Folder to create");
  command.add_flag("--keep-identity", a->keeps_identity, "Keep the objects as they are, with the patient's identity");
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.when_parsed([&action, a] { action = [a] { return fetch(*a); }; });
}

}  // namespace trocar::cli
