// trocar patient show, check and render: contents of a patient.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "anatomy/label_statistics.h"
#include "cases/prepare_case.h"
#include "cli/commands.h"
#include "cli/constants.h"
#include "cli/json_parts.h"
#include "cli/patient/summary.h"
#include "cli/patient_option.h"
#include "config/json.h"
#include "core/files/output_file.h"
#include "io/markups_file.h"
#include "io/patient/patient_cache.h"
#include "io/patient/patient_extras.h"
#include "patient_builder/patient_findings.h"
#include "png/png_file.h"
#include "report/patient_report.h"
#include "scene/render_patient.h"
#include "slices/slice_picture.h"
#include "tasks/assess_path.h"
#include "tasks/needle.h"
#include "tasks/task.h"

namespace trocar::cli {
namespace {
namespace fs = std::filesystem;

struct PatientArguments {
  io::PatientSource source;
  bool is_json = false;
  std::string paths;  ///< Markups file with needle paths to draw; empty: those of the patient.
  std::string out;
  std::string pictures, report;  ///< Of `check`; empty: none.
};

/// Contents of a patient's folder besides the patient.
struct OwnFiles {
  bool has_panorama = false;
  std::optional<anatomy::TissueTable> tissues;  ///< The table that was fitted to it.
};

Result<OwnFiles> own_files(const PatientArguments& arguments) {
  OwnFiles own;
  own.has_panorama = io::has_panorama(arguments.source);
  if (!cases::has_own_tissues(arguments.source.folder_or_name)) return own;
  TROCAR_TRY(own.tissues, cases::load_own_tissues(arguments.source.folder_or_name));
  return own;
}

config::Json tissues_json(const OwnFiles& own) {
  if (!own.tissues) return {};
  const anatomy::PathConstraintLaw& constraint = own.tissues->path_constraint;
  config::Json json = {{"origin", own.tissues->origin}};
  json["path_constraint"] = constraint.is_given
                                ? config::Json{{"m0_n", constraint.force_n}, {"n0_nmm", constraint.torque_nmm}}
                                : config::Json();
  return json;
}

void print_own_files(const OwnFiles& own) {
  if (own.has_panorama) fmt::print("\nultrasound panorama {}\n", io::kPanoramaFile);
  if (!own.tissues) return;
  fmt::print("\ntissues from {}\n", own.tissues->origin);
  const anatomy::PathConstraintLaw& constraint = own.tissues->path_constraint;
  if (constraint.is_given)
    fmt::print("path constraint m0 {:g} N, n0 {:g} N mm\n", constraint.force_n, constraint.torque_nmm);
}

config::Json patient_json(const anatomy::VirtualPatient& patient, const std::vector<anatomy::NamedMesh>& meshes,
                          const OwnFiles& own) {
  config::Json labels = config::Json::array();
  for (const anatomy::LabelStatistics& s : anatomy::label_statistics(patient)) labels.push_back(label_json(patient, s));
  config::Json surfaces = config::Json::array();
  for (const anatomy::NamedMesh& m : meshes) surfaces.push_back(mesh_json(m));
  config::Json landmarks = config::Json::array();
  for (const anatomy::Landmark& l : patient.landmarks)
    landmarks.push_back({{"name", l.name}, {"position_mm", vector_json(l.p_P)}});
  config::Json paths = config::Json::array();
  for (const anatomy::NeedlePath& p : patient.paths) {
    paths.push_back({{"name", p.name},
                     {"entry_mm", vector_json(p.line_P.a)},
                     {"target_mm", vector_json(p.line_P.b)},
                     {"length_mm", p.line_P.length_mm()}});
  }
  return {{"name", patient.name},
          {"description", patient.description},
          {"provenance", patient.provenance},
          {"content_hash", patient.content_hash},
          {"volumes", {{"ct", grid_json(patient.ct.geometry)}, {"labels", grid_json(patient.labels.geometry)}}},
          {"labels", labels},
          {"meshes", surfaces},
          {"landmarks", landmarks},
          {"paths", paths},
          {"panorama", own.has_panorama},
          {"tissues", tissues_json(own)}};
}

void print_patient(const anatomy::VirtualPatient& patient, const std::vector<anatomy::NamedMesh>& meshes,
                   const OwnFiles& own) {
  fmt::print("{}{}{}\n", patient.name, patient.description.empty() ? "" : ": ", patient.description);
  for (const std::string& line : patient.provenance) fmt::print("  from {}\n", line);
  fmt::print("  content {}\n\n", patient.content_hash);

  const volume::GridGeometry& g = patient.ct.geometry;
  fmt::print("volumes    {} x {} x {} voxels of {:.3f} x {:.3f} x {:.3f} mm, frame P (LPS, mm)\n", g.size[0], g.size[1],
             g.size[2], g.spacing_mm.x(), g.spacing_mm.y(), g.spacing_mm.z());
  fmt::print("           first voxel at ({:.2f}, {:.2f}, {:.2f}) mm\n", g.origin_P.x(), g.origin_P.y(), g.origin_P.z());
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 d = g.R_PV.col(axis);
    fmt::print("           {} runs along ({:.4f}, {:.4f}, {:.4f})\n", "ijk"[axis], d.x(), d.y(), d.z());
  }

  fmt::print("\n{:>3}  {:<30} {:<16} {:>11} {:>9}\n", "id", "label", "tissue", "volume", "mean");
  for (const anatomy::LabelStatistics& s : anatomy::label_statistics(patient)) {
    const anatomy::Label* label = patient.label_table.find(s.id);
    if (label == nullptr) continue;
    fmt::print("{:>3}  {:<30} {:<16} {:>8.1f} ml {:>6.0f} HU{}\n", s.id, label->name, label->tissue, s.volume_ml,
               s.mean_hu, label->is_derived ? "  derived" : "");
  }
  fmt::print("\n{:<35} {:>10} {:>15} {:>11}\n", "mesh", "triangles", "area", "volume");
  for (const anatomy::NamedMesh& m : meshes) {
    fmt::print("{:<35} {:>10} {:>11.1f} cm2 {:>8.1f} ml\n", m.name, m.mesh_P.triangles.size(),
               area_mm2(m.mesh_P) / kMm2PerCm2, enclosed_volume_mm3(m.mesh_P) / kMm3PerMl);
  }
  if (!patient.landmarks.empty()) fmt::print("\n");
  for (const anatomy::Landmark& l : patient.landmarks) {
    fmt::print("landmark {:<26} ({:.1f}, {:.1f}, {:.1f}) mm\n", l.name, l.p_P.x(), l.p_P.y(), l.p_P.z());
  }
  for (const anatomy::NeedlePath& p : patient.paths)
    fmt::print("path {:<30} {:.1f} mm\n", p.name, p.line_P.length_mm());
  print_own_files(own);
}

Status show_patient(const PatientArguments& arguments) {
  const ProgressPrinter printer;
  TROCAR_TRY(const OwnFiles own, own_files(arguments));
  TROCAR_TRY(const anatomy::VirtualPatient patient, io::open_patient(arguments.source, printer.callback()));
  TROCAR_TRY(const auto meshes, io::open_meshes(arguments.source, patient, printer.callback()));
  if (arguments.is_json) {
    print_json(patient_json(patient, meshes, own));
  } else {
    print_patient(patient, meshes, own);
  }
  return {};
}

struct CheckedTask {
  tasks::Task task;
  tasks::TaskReadiness readiness;
};

/// The tasks of the data folder and the patient's own, each with its needle.
Result<std::vector<CheckedTask>> checked_tasks(const PatientArguments& arguments,
                                               const anatomy::VirtualPatient& patient, const Progress& progress) {
  TROCAR_TRY(const fs::path folder, find_data("tasks"));
  TROCAR_TRY(const fs::path needles, find_data("needles.toml"));
  TROCAR_TRY(const auto tasks, tasks::load_tasks(folder));
  std::vector<CheckedTask> checked;
  const auto check = [&](const tasks::Task& task) -> Status {
    TROCAR_TRY(const tasks::Needle needle, tasks::load_needle(needles, task.needle));
    checked.push_back({task, tasks::check_task_and_paths(task, patient, needle, progress)});
    return {};
  };
  for (const tasks::Task& task : tasks) TROCAR_TRY_STATUS(check(task));
  if (cases::has_own_task(arguments.source.folder_or_name)) {
    TROCAR_TRY(tasks::Task task,
               tasks::load_task_file(fs::path(arguments.source.folder_or_name) / tasks::kOwnTaskFile, folder));
    task.name += fmt::format(" ({})", tasks::kOwnTaskFile);
    TROCAR_TRY_STATUS(check(task));
  }
  return checked;
}

struct CheckResult {
  std::vector<CheckedTask> tasks;
  std::vector<anatomy::Finding> findings;
  bool has_panorama = false;
};

Result<CheckResult> check_patient(const PatientArguments& arguments, const anatomy::VirtualPatient& patient,
                                  const Progress& progress) {
  CheckResult result;
  TROCAR_TRY(result.tasks, checked_tasks(arguments, patient, progress));
  result.findings = patient_builder::all_patient_findings(patient, anatomy::label_statistics(patient));
  if (patient.paths.empty()) result.findings.push_back({"no expert path is stored; trocar run plans one", {}, {}});
  if (cases::has_own_tissues(arguments.source.folder_or_name))
    if (const auto own = cases::load_own_tissues(arguments.source.folder_or_name); !own)
      result.findings.push_back({own.error().text(), {}, {}});
  result.has_panorama = io::has_panorama(arguments.source);
  if (!result.has_panorama) return result;
  if (const auto panorama = io::load_panorama(arguments.source); !panorama)
    result.findings.push_back({panorama.error().text(), {}, {}});
  return result;
}

std::vector<std::string> task_lines(const std::vector<CheckedTask>& tasks) {
  std::vector<std::string> lines;
  for (const auto& [task, readiness] : tasks) {
    lines.push_back(fmt::format("{:<16} {}{}", task.name, readiness.is_possible ? "possible" : "not possible",
                                readiness.is_parenchymal ? " (parenchymal)" : ""));
    for (const std::string& reason : readiness.reasons) lines.push_back("  " + reason);
  }
  return lines;
}

config::Json findings_json(const std::vector<anatomy::Finding>& findings) {
  config::Json list = config::Json::array();
  for (const anatomy::Finding& finding : findings)
    list.push_back({{"text", finding.text},
                    {"label", finding.label},
                    {"position_mm", finding.place_P ? vector_json(*finding.place_P) : config::Json()}});
  return list;
}

void print_check(const anatomy::VirtualPatient& patient, const CheckResult& result, bool is_json) {
  if (is_json) {
    config::Json list = config::Json::array(), texts = config::Json::array(), derived = config::Json::array();
    for (const auto& [task, readiness] : result.tasks) list.push_back(readiness_json(task, readiness));
    for (const anatomy::Finding& finding : result.findings) texts.push_back(finding.text);
    for (const anatomy::Label& label : patient.label_table.labels)
      if (label.is_derived) derived.push_back(label.name);
    print_json({{"name", patient.name},
                {"tasks", list},
                {"panorama", result.has_panorama},
                {"doubtful", texts},
                {"doubts", findings_json(result.findings)},
                {"repairs", findings_json(patient.repairs)},
                {"derived", derived}});
    return;
  }
  for (const std::string& line : task_lines(result.tasks)) fmt::print("{}\n", line);
  if (result.has_panorama) fmt::print("{:<16} {}\n", "panorama", io::kPanoramaFile);
  if (!result.findings.empty()) fmt::print("doubtful\n");
  for (const anatomy::Finding& finding : result.findings) fmt::print("  {}\n", finding.text);
  if (!patient.repairs.empty()) fmt::print("repaired\n");
  for (const anatomy::Finding& repair : patient.repairs) fmt::print("  {}\n", repair.text);
  std::vector<std::string> derived;
  for (const anatomy::Label& label : patient.label_table.labels)
    if (label.is_derived) derived.push_back(label.name);
  if (!derived.empty()) fmt::print("derived\n  {}\n", fmt::join(derived, ", "));
}

/// One picture for each place: doubt_1.png, repair_1.png …
Status write_pictures(const anatomy::VirtualPatient& patient, const CheckResult& result, const fs::path& folder) {
  return write_folder_atomically(folder, [&](const fs::path& temporary) -> Status {
    const auto write = [&](const std::vector<anatomy::Finding>& findings, const char* kind) -> Status {
      for (std::size_t n = 0; n < findings.size(); ++n)
        if (findings[n].place_P)
          TROCAR_TRY_STATUS(png::write_png(report::finding_picture(patient, findings[n]),
                                           temporary / fmt::format("{}_{}.png", kind, n + 1)));
      return {};
    };
    TROCAR_TRY_STATUS(write(result.findings, "doubt"));
    return write(patient.repairs, "repair");
  });
}

Status check(const PatientArguments& arguments) {
  for (const std::string& out : {arguments.pictures, arguments.report})
    if (!out.empty()) TROCAR_TRY_STATUS(check_new(out));
  const ProgressPrinter printer;
  TROCAR_TRY(const anatomy::VirtualPatient patient, io::open_patient(arguments.source, printer.callback()));
  TROCAR_TRY(const CheckResult result, check_patient(arguments, patient, printer.callback()));
  if (!arguments.pictures.empty()) TROCAR_TRY_STATUS(write_pictures(patient, result, arguments.pictures));
  if (!arguments.report.empty())
    TROCAR_TRY_STATUS(write_file_atomically(
        arguments.report, report::patient_report(patient, {task_lines(result.tasks), result.findings})));
  print_check(patient, result, arguments.is_json);
  return {};
}

/// Focal point of the pictures: the target of the first path, else the first lesion, else the liver, else the centre.
Vec3 point_of_interest(const anatomy::VirtualPatient& patient) {
  if (!patient.paths.empty()) return patient.paths.front().line_P.b;
  const auto statistics = anatomy::label_statistics(patient);
  for (const std::string_view wanted : {"liver_lesion", "liver"}) {
    const auto found = std::find_if(statistics.begin(), statistics.end(), [&](const anatomy::LabelStatistics& s) {
      const anatomy::Label* label = patient.label_table.find(s.id);
      return label != nullptr && label->tissue == wanted && s.voxels > 0;
    });
    if (found != statistics.end()) return found->centroid_P;
  }
  const auto& size = patient.ct.geometry.size;
  return patient.ct.geometry.to_mm(
      0.5 * Vec3(static_cast<double>(size[0] - 1), static_cast<double>(size[1] - 1), static_cast<double>(size[2] - 1)));
}

Status write_slices(const anatomy::VirtualPatient& patient, const fs::path& folder) {
  constexpr std::array<std::pair<slices::SliceOrientation, const char*>, 3> kOrientations = {
      {{slices::SliceOrientation::kAxial, "axial"},
       {slices::SliceOrientation::kCoronal, "coronal"},
       {slices::SliceOrientation::kSagittal, "sagittal"}}};
  const Vec3 through_P = point_of_interest(patient);
  slices::SliceOptions plain;
  plain.label_opacity = 0.0;
  plain.has_outlines = false;
  for (const auto& [orientation, name] : kOrientations) {
    for (const auto& [options, ending] : {std::pair{plain, ""}, std::pair{slices::SliceOptions{}, "_labels"}}) {
      slices::SlicePicture picture = slices::make_slice_picture(patient, orientation, through_P, options);
      slices::draw_slice_legend(picture);
      TROCAR_TRY_STATUS(png::write_png(picture.image, folder / fmt::format("slice_{}{}.png", name, ending)));
    }
  }
  return {};
}

/// One picture per camera.
Status write_views(const anatomy::VirtualPatient& patient, const std::vector<anatomy::NamedMesh>& meshes,
                   const fs::path& folder, const Progress& progress) {
  constexpr std::array<std::pair<scene::CameraPreset, const char*>, 4> kCameras = {
      {{scene::CameraPreset::kRightAnteriorOblique, "right_anterior_oblique"},
       {scene::CameraPreset::kAnterior, "anterior"},
       {scene::CameraPreset::kRight, "right"},
       {scene::CameraPreset::kPosterior, "posterior"}}};
  double fraction = 0.5;
  for (const auto& [camera, name] : kCameras) {
    core::report(progress, "drawing 3D pictures", fraction);
    fraction += 0.1;
    scene::SceneOptions options;
    options.camera = camera;
    options.paths = patient.paths;
    TROCAR_TRY(const image::RgbImage picture, scene::render_patient(patient, meshes, options));
    TROCAR_TRY_STATUS(png::write_png(picture, folder / fmt::format("view_{}.png", name)));
  }
  return {};
}

Status render(const PatientArguments& arguments) {
  TROCAR_TRY_STATUS(check_new(arguments.out));
  const ProgressPrinter printer;
  const Progress progress = printer.callback();
  TROCAR_TRY(anatomy::VirtualPatient patient, io::open_patient(arguments.source, progress));
  if (!arguments.paths.empty()) {
    TROCAR_TRY(patient.paths, io::read_paths(arguments.paths));
  }
  TROCAR_TRY(const auto meshes, io::open_meshes(arguments.source, patient, progress));
  const bool can_draw = scene::can_render();
  const auto draw = [&](const fs::path& folder) -> Status {
    core::report(progress, "drawing slices", 0.4);
    TROCAR_TRY_STATUS(write_slices(patient, folder));
    return can_draw ? write_views(patient, meshes, folder, progress) : Status{};
  };
  TROCAR_TRY_STATUS(write_folder_atomically(arguments.out, draw));
  if (!can_draw) {
    print_warning("no 3D pictures, slices only — there is no X server — start this command under xvfb-run");
  }
  return {};
}

Command add_command(Command& patient, Action& action, const char* name, const char* description,
                    Status (*work)(const PatientArguments&), std::shared_ptr<PatientArguments> arguments) {
  Command command = patient.add_command(name, description);
  command.add_option("PATIENT", arguments->source.folder_or_name, "Patient folder, or an embedded patient's name")
      .required();
  command.add_option("--seed", arguments->source.seed, "Seed of an embedded patient").seed().show_default();
  add_cache_option(command, arguments->source);
  command.when_parsed([&action, arguments, work] { action = [arguments, work] { return work(*arguments); }; });
  return command;
}

}  // namespace

void add_patient_report_commands(Command& patient, Action& action) {
  const auto arguments = std::make_shared<PatientArguments>();  // one command runs: they share the arguments
  Command show_command =
      add_command(patient, action, "show", "Labels with volumes, meshes, frames, provenance", show_patient, arguments);
  show_command.add_flag("--json", arguments->is_json, "Print one JSON object");
  show_command.footer("Example:\n  trocar patient show my_patient\n");

  Command check_command = add_command(patient, action, "check",
                                      "List the tasks that a patient supports, and doubtful results", check, arguments);
  check_command.add_flag("--json", arguments->is_json, "Print one JSON object");
  check_command.add_option("--pictures", arguments->pictures,
                           "Folder to create, with a picture of each doubtful place");
  check_command.add_option("--report", arguments->report, "HTML page to write, with these pictures");
  check_command.footer("Example:\n  trocar patient check my_patient --report check.html\n");

  Command render_command = add_command(
      patient, action, "render", "Render CT slices, and 3D images if an X server is available", render, arguments);
  render_command.add_option("--out", arguments->out, "Folder to create").required();
  render_command.add_option("--paths", arguments->paths, "Needle paths to draw, as trocar plan writes them");
  render_command.footer("Example:\n  xvfb-run -a trocar patient render my_patient --out pictures\n");
}

}  // namespace trocar::cli
