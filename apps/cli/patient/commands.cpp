// trocar patient list, generate and build: sources of patients.
#include "cli/commands.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "cases/prepare_case.h"
#include "cli/patient/summary.h"
#include "cli/patient/thumbnail.h"
#include "config/json.h"
#include "core/files/output_file.h"
#include "core/progress.h"
#include "core/text.h"
#include "io/ct_series/dicom_folder.h"
#include "io/patient/build_from_files.h"
#include "io/patient/patient_extras.h"
#include "io/patient/patient_folder.h"
#include "motion_builder/breathing_model.h"
#include "patient_builder/plausibility/judge_anatomy.h"
#include "phantom/phantom.h"
#include "png/png_file.h"
#include "surface/extract_surface.h"

namespace trocar::cli {
namespace {
namespace fs = std::filesystem;

config::Json list_json() {
  config::Json patients = config::Json::array();
  for (const phantom::PhantomInfo& info : phantom::embedded_patients()) {
    const auto thumbnail = io::find_thumbnail(info.name);
    patients.push_back({{"name", info.name},
                        {"description", info.description},
                        {"briefing", info.briefing},
                        {"tasks", info.tasks},
                        {"difficulty", info.difficulty > 0 ? config::Json(info.difficulty) : config::Json()},
                        {"thumbnail", thumbnail ? config::Json(thumbnail->string()) : config::Json()}});
  }
  return {{"patients", patients}};
}

void print_listed(const phantom::PhantomInfo& info) {
  const std::string difficulty = info.difficulty > 0 ? fmt::format("{} of 5", info.difficulty) : "-";
  fmt::print("  {:<14} {:<7} {}\n", info.name, difficulty, info.description);
  if (const auto thumbnail = io::find_thumbnail(info.name))
    fmt::print("  {:<14} {:<7} {}\n", "", "", thumbnail->string());
}

Status list_patients(bool is_json) {
  if (is_json) {
    print_json(list_json());
    return {};
  }
  std::map<std::string, std::vector<const phantom::PhantomInfo*>> by_task;
  const std::vector<phantom::PhantomInfo> all = phantom::embedded_patients();
  for (const phantom::PhantomInfo& info : all) {
    for (const std::string& task : info.tasks) by_task[task].push_back(&info);
  }
  for (const auto& [task, patients] : by_task) {
    fmt::print("{}: name, difficulty, description, thumbnail\n", task);
    for (const phantom::PhantomInfo* info : patients) print_listed(*info);
  }
  fmt::print("without a task\n");
  for (const phantom::PhantomInfo& info : all) {
    if (info.tasks.empty()) print_listed(info);
  }
  return {};
}

/// Writes the folder and returns the surfaces in it. Its thumbnail shows slices: see draw_in_3d.
Result<std::vector<anatomy::NamedMesh>> save_with_surfaces(const anatomy::VirtualPatient& patient, const fs::path& out,
                                                           const Progress& progress,
                                                           std::vector<io::PatientExtra> extras = {}) {
  auto meshes = surface::extract_surfaces(patient, {}, part_of(progress, 0.0, 0.5));
  const image::RgbImage thumbnail = slices::make_slice_thumbnail(patient, slices::find_thumbnail_region(patient));
  extras.push_back({io::kThumbnailFile, png::encode_png(thumbnail)});
  TROCAR_TRY_STATUS(io::save_patient(patient, meshes, out, part_of(progress, 0.6, 1.0), extras));
  return meshes;
}

/// Draws the thumbnail of a saved patient anew, in 3D if an X server is there. After everything else: the program ends
/// if the X server does.
void draw_in_3d(const anatomy::VirtualPatient& patient, const std::vector<anatomy::NamedMesh>& meshes,
                const fs::path& folder) {
  const auto thumbnail = make_thumbnail(patient, meshes, slices::find_thumbnail_region(patient));
  const Status written =
      thumbnail ? png::write_png(*thumbnail, folder / io::kThumbnailFile) : tl::unexpected(thumbnail.error());
  if (!written) print_warning(fmt::format("the thumbnail shows slices, not 3D: {}", written.error().text()));
}

Status generate_patient(const std::string& name, std::uint64_t seed, double voxel_mm, const fs::path& out) {
  TROCAR_TRY_STATUS(check_new(out));
  const ProgressPrinter printer;
  const Progress progress = printer.callback();
  TROCAR_TRY(anatomy::VirtualPatient patient,
             phantom::generate_phantom(name, seed, {{0, 0, 0}, voxel_mm}, part_of(progress, 0.0, 0.4)));
  io::round_as_saved(patient);
  motion_builder::add_breathing_model(patient, part_of(progress, 0.4, 0.5));
  TROCAR_TRY(const auto meshes, save_with_surfaces(patient, out, part_of(progress, 0.5, 1.0)));
  draw_in_3d(patient, meshes, out);
  return {};
}

struct BuildArguments {
  std::string ct;
  std::vector<std::string> labels;
  std::string label_map = "totalsegmentator";
  std::string name;
  std::string series;
  std::string rescale;  ///< "SLOPE,INTERCEPT", or empty.
  std::string derive = "all";
  std::string posture = "supine";
  std::string mirror;  ///< "labels", "both", or empty.
  std::vector<std::string> confirmed;
  std::string tissues;  ///< Tissue table to put into the folder; empty: none.
  std::string out;
  bool sibling_series = false;
  bool is_json = false;
};

Result<std::optional<anatomy::Rescale>> parse_rescale(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto slope = find_leading_number<double>(text);
  const bool is_pair = slope && slope->value != 0.0 && slope->rest.starts_with(',');
  if (const auto intercept = is_pair ? parse_number<double>(slope->rest.substr(1)) : std::nullopt)
    return anatomy::Rescale{slope->value, *intercept};
  return fail_usage("--rescale needs two finite numbers, the first not 0", text,
                    "write SLOPE,INTERCEPT such as 1,-1024");
}

/// The patient's own tissue table as a file of its folder.
Result<std::vector<io::PatientExtra>> read_tissues(const std::string& file) {
  if (file.empty()) return std::vector<io::PatientExtra>{};
  TROCAR_TRY_STATUS(anatomy::load_tissue_table(file));
  TROCAR_TRY(std::string text, read_file(file));
  return std::vector<io::PatientExtra>{{cases::kOwnTissueFile, std::move(text)}};
}

Result<anatomy::Posture> parse_posture(const std::string& name) {
  if (const auto posture = anatomy::find_posture(name)) return *posture;
  return fail_usage("there is no such posture", name, "give supine, prone, left-lateral, right-lateral or sitting");
}

Result<io::Mirroring> parse_mirroring(const std::string& text) {
  if (text.empty()) return io::Mirroring::kNone;
  if (text == "labels") return io::Mirroring::kLabels;
  if (text == "both") return io::Mirroring::kBoth;
  return fail_usage("--mirror needs what was mirrored", text, "write --mirror labels or --mirror both");
}

Status build(const BuildArguments& arguments) {
  TROCAR_TRY_STATUS(check_new(arguments.out));
  TROCAR_TRY(const fs::path tasks_folder, find_data("tasks"));
  TROCAR_TRY(const auto tasks, tasks::load_tasks(tasks_folder));
  io::PatientFiles files;
  files.ct = arguments.ct;
  files.labels.assign(arguments.labels.begin(), arguments.labels.end());
  files.label_map = arguments.label_map;
  files.series = arguments.series;
  files.sibling_series = arguments.sibling_series;
  TROCAR_TRY(files.rescale, parse_rescale(arguments.rescale));
  TROCAR_TRY(files.posture, parse_posture(arguments.posture));
  TROCAR_TRY(const auto extras, read_tissues(arguments.tissues));
  TROCAR_TRY(files.derive, patient_builder::parse_derive_choice(arguments.derive));
  TROCAR_TRY(files.mirroring, parse_mirroring(arguments.mirror));
  TROCAR_TRY_STATUS(patient_builder::check_confirmable(arguments.confirmed));
  files.confirmed = arguments.confirmed;
  files.name = arguments.name.empty() ? io::last_name(arguments.out) : arguments.name;
  std::vector<std::string> warnings;
  std::vector<anatomy::NamedMesh> meshes;
  anatomy::VirtualPatient patient;
  {
    const ProgressPrinter printer;
    const Progress progress = printer.callback();
    TROCAR_TRY(patient, io::build_from_files(files, warnings, part_of(progress, 0.0, 0.5)));
    TROCAR_TRY(meshes, save_with_surfaces(patient, arguments.out, part_of(progress, 0.5, 1.0), extras));
  }
  for (const std::string& warning : warnings) print_warning(warning);
  const BuildSummary summary = summarize_build(patient, tasks, std::move(warnings), arguments.out);
  if (arguments.is_json) {
    print_json(to_json(summary, patient, meshes));
  } else {
    print_summary(summary, patient, meshes);
  }
  std::fflush(stdout);
  draw_in_3d(patient, meshes, arguments.out);
  return {};
}

struct SeriesArguments {
  std::string folder;
  bool is_json = false;
};

Status list_series(const SeriesArguments& arguments) {
  TROCAR_TRY(const auto series, io::list_dicom_series(arguments.folder));
  config::Json list = config::Json::array();
  if (!arguments.is_json)
    fmt::print("{:>6} {:<8} {:>6} {:>9}  {:<32} {}\n", "number", "modality", "images", "pixels", "description", "UID");
  for (std::size_t n = 0; n < series.size(); ++n) {
    const io::DicomSeriesInfo& s = series[n];
    if (!arguments.is_json)
      fmt::print("{:>6} {:<8} {:>6} {:>9}  {:<32} {}\n", n + 1, s.modality, s.images,
                 fmt::format("{}x{}", s.columns, s.rows), s.description, s.uid);
    list.push_back({{"number", n + 1},
                    {"uid", s.uid},
                    {"description", s.description},
                    {"modality", s.modality},
                    {"images", s.images},
                    {"columns", s.columns},
                    {"rows", s.rows},
                    {"folder", s.folder.string()}});
  }
  if (arguments.is_json) print_json({{"series", list}});
  return {};
}

}  // namespace

void add_patient_commands(Command& program, Action& action) {
  Command patient = program.add_command("patient", "Create, show and check virtual patients");
  patient.require_command();
  patient.footer("Example:\n  trocar patient generate abdomen --out my_patient\n");

  Command list = patient.add_command("list", "List embedded patients: task, difficulty from 1 to 5, thumbnail");
  list.footer("Example:\n  trocar patient list\n");
  const auto is_json = std::make_shared<bool>(false);
  list.add_flag("--json", *is_json, "Print one JSON object");
  list.when_parsed([&action, is_json] { action = [is_json] { return list_patients(*is_json); }; });

  struct GenerateArguments {
    std::string name = std::string(phantom::kVariantPatient);
    std::uint64_t seed = 1;
    double voxel_mm = 0.0;
    std::string out;
  };
  Command generate = patient.add_command("generate", "Write an embedded patient to a folder");
  generate.footer("Example:\n  trocar patient generate abdomen --seed 7 --out abdomen_7\n");
  const auto g = std::make_shared<GenerateArguments>();
  generate
      .add_option("NAME", g->name,
                  "Embedded patient: see trocar patient list; \"variant\" is a body drawn by the seed from the whole "
                  "range of bodies")
      .show_default();
  generate.add_option("--out", g->out, "Folder to create").required();
  generate.add_option("--seed", g->seed, "Random seed; each seed gives a different individual").seed().show_default();
  generate.add_option("--voxel-mm", g->voxel_mm, "Edge of the voxels; without it 1 mm or finer")
      .number_within(0.5, 10.0, "mm");
  generate.when_parsed(
      [&action, g] { action = [g] { return generate_patient(g->name, g->seed, g->voxel_mm, g->out); }; });

  Command build_command = patient.add_command("build", "Build a patient from a CT and its segmentation");
  build_command.footer(
      "Examples:\n  trocar patient build --ct ct.nii.gz --labels segmentation.nii.gz --out case_1\n"
      "  trocar patient build --ct dicom_folder --labels masks_folder --label-map names.toml --out case_2\n"
      "  trocar patient build --ct dicom_disc --series 2 --labels segmentation.nii.gz --out case_3\n"
      "  trocar patient build --ct dicom_disc --labels dicom_disc/RTSTRUCT --out case_4\n"
      "  trocar patient build --ct ct.nii.gz --labels segmentation.nii.gz --posture left-lateral --out lumbar_1\n");
  const auto b = std::make_shared<BuildArguments>();
  build_command.add_option("--ct", b->ct, "CT: NIfTI, NRRD, MHA, or a folder of DICOM files with its sub-folders")
      .required();
  build_command.add_option("--series", b->series,
                           "Number or UID of the DICOM series of the CT, see trocar patient series; required if the "
                           "folder contains several CT series and the labels refer to none of them");
  build_command
      .add_option(
          "--labels", b->labels,
          "Label volumes, .seg.nrrd, single masks, folders of masks or of DICOM mask series, DICOM SEG and RTSTRUCT "
          "files or their folder")
      .required();
  build_command.add_flag("--sibling-series", b->sibling_series,
                         "Accept a DICOM SEG or RTSTRUCT of another series with the same frame of reference, such as "
                         "another reconstruction of the scan");
  build_command
      .add_option("--label-map", b->label_map,
                  "Names of labels: totalsegmentator, totalsegmentator:TASK (liver_vessels, tissue_types ...), a data "
                  "set such as "
                  "lits, btcv or verse, or a TOML file with [labels] and ignore (see the user guide)")
      .show_default();
  build_command.add_option("--rescale", b->rescale,
                           "SLOPE,INTERCEPT of a CT whose file lacks them: HU = SLOPE * stored number + INTERCEPT");
  build_command
      .add_option("--derive", b->derive,
                  "Thin structures to add where their neighbours are labelled: all, none, or names separated by commas")
      .show_default();
  build_command
      .add_option("--posture", b->posture,
                  "How the patient lies for the puncture: supine, prone, left-lateral, right-lateral, sitting")
      .show_default();
  build_command.add_option("--mirror", b->mirror,
                           "Mirror left to right what its file has mirrored: labels, or both (the CT, too)");
  build_command.add_option(
      "--confirm", b->confirmed,
      "A finding about the whole segmentation that is right: mirrored (situs inversus), turned, "
      "shifted, numbers, other-ct, cropped, missing, sizes, places, hu, posture; can be given several "
      "times");
  build_command.add_option("--tissues", b->tissues,
                           "Tissue table (TOML) fitted to this patient: stored in the folder and used by its attempts");
  build_command.add_option("--name", b->name, "Name of the patient; default: the folder's name");
  build_command.add_option("--out", b->out, "Folder to create").required();
  build_command.add_flag("--json", b->is_json, "Print the summary as one JSON object");
  build_command.when_parsed([&action, b] { action = [b] { return build(*b); }; });

  Command series_command = patient.add_command("series", "List the DICOM series of a folder and its sub-folders");
  series_command.footer("Example:\n  trocar patient series dicom_disc\n");
  const auto s = std::make_shared<SeriesArguments>();
  series_command.add_option("FOLDER", s->folder, "Folder of DICOM files").required();
  series_command.add_flag("--json", s->is_json, "Print one JSON object");
  series_command.when_parsed([&action, s] { action = [s] { return list_series(*s); }; });

  add_patient_fetch_command(patient, action);
  add_patient_export_command(patient, action);
  add_patient_motion_command(patient, action);
  add_patient_variants_command(patient, action);
  add_thumbnail_command(patient, action);
  add_patient_report_commands(patient, action);
}

}  // namespace trocar::cli
