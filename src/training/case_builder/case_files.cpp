#include "case_builder/case_files.h"

#include <fmt/format.h>

#include <filesystem>

#include "case_builder/ultrasound.h"
#include "cases/prepare_case.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/progress.h"
#include "io/patient/build_from_files.h"
#include "io/patient/patient_cache.h"
#include "io/patient/patient_extras.h"
#include "io/patient/patient_folder.h"
#include "patient_builder/plausibility/judge_anatomy.h"
#include "patient_builder/repair/repair_segmentation.h"
#include "phantom/phantom.h"
#include "png/png_file.h"
#include "slices/slice_picture.h"
#include "surface/extract_surface.h"

namespace trocar::case_builder {
namespace {
namespace fs = std::filesystem;

constexpr double kVolumesPart = 0.55;  // share of an import's time; the surfaces take the rest

bool is_patient_folder(const std::string& path) {
  std::error_code ignored;
  return fs::exists(fs::path(path) / "patient.toml", ignored);
}

Status check_request(const ImportRequest& request) {
  if (request.ct.empty()) return fail_usage("no CT given", {}, "choose a file, a DICOM folder, or a patient folder");
  if (is_whole_patient(request)) {
    if (request.labels.empty()) return {};
    return fail_usage("this patient already has labels", request.ct, "omit the labels");
  }
  if (request.labels.empty())
    return fail_usage("no labels given", request.ct, "choose a segmentation of this CT: a case needs its structures");
  return {};
}

Result<anatomy::VirtualPatient> read_patient(const ImportRequest& request, std::vector<std::string>& warnings,
                                             std::vector<patient_builder::AnatomyFinding>& findings,
                                             const Progress& progress, const std::stop_token& stop) {
  if (is_whole_patient(request)) {
    TROCAR_TRY(anatomy::VirtualPatient patient, io::open_patient({request.ct, 1}, progress));
    findings = patient_builder::judge_anatomy(patient);
    return patient;
  }
  io::PatientFiles files;
  files.ct = request.ct;
  files.labels.assign(request.labels.begin(), request.labels.end());
  files.label_map = request.label_map;
  files.name = fs::path(io::last_name(request.ct)).stem().stem().string();
  files.posture = request.posture;
  files.sibling_series = request.sibling_series;
  files.mirroring = request.mirroring;
  files.confirmed = request.confirmed;
  files.findings = &findings;
  auto patient = io::build_from_files(files, warnings, progress, stop);
  if (request.findings != nullptr) *request.findings = findings;
  return patient;
}

}  // namespace

bool is_whole_patient(const ImportRequest& request) {
  if (is_patient_folder(request.ct)) return true;
  return phantom::find_embedded_patient(request.ct).has_value();
}

Result<CaseDraft> import_case(const ImportRequest& request, const Progress& progress, const std::stop_token& stop) {
  TROCAR_TRY_STATUS(check_request(request));
  cases::CaseOptions options;
  options.task = request.task;
  TROCAR_TRY(const cases::Case tables, cases::load_tables(options));

  auto imported = std::make_shared<ImportedPatient>();
  imported->source = request.ct;
  TROCAR_TRY(imported->patient,
             read_patient(request, imported->warnings, imported->findings, part_of(progress, 0.0, kVolumesPart), stop));
  if (stop.stop_requested()) return fail("stopped", request.ct, "start the import again");
  const Progress surfaces = part_of(progress, kVolumesPart, 1.0);
  if (is_patient_folder(request.ct)) {
    TROCAR_TRY(imported->meshes, io::open_meshes({request.ct, 1}, imported->patient, surfaces));
  } else {
    imported->meshes = surface::extract_surfaces(imported->patient, {}, surfaces);
  }
  imported->statistics = anatomy::label_statistics(imported->patient);
  imported->label_findings = patient_builder::segmentation_findings(imported->patient);

  CaseDraft draft;
  draft.name = imported->patient.name;
  draft.description = imported->patient.description;
  draft.provenance = imported->patient.provenance;
  draft.label_table = imported->patient.label_table;
  draft.landmarks = imported->patient.landmarks;
  draft.paths = imported->patient.paths;
  draft.base = draft.task = tables.task;
  if (cases::has_own_task(request.ct)) {
    options.task.clear();
    options.patient_folder = request.ct;
    TROCAR_TRY(const cases::Case own, cases::load_tables(options));
    draft.task = own.task;
    options.task = own.task.name;
    TROCAR_TRY(const cases::Case base, cases::load_tables(options));
    draft.base = base.task;
  }
  if (cases::has_own_tissues(request.ct)) {
    TROCAR_TRY_STATUS(cases::load_own_tissues(request.ct));
    TROCAR_TRY(imported->own_tissues, read_file(fs::path(request.ct) / cases::kOwnTissueFile));
  }
  if (is_patient_folder(request.ct)) {
    // A damaged panorama does not prevent the import of the patient.
    if (auto with_ultrasound = add_saved_ultrasound(draft, request.ct)) {
      draft = *std::move(with_ultrasound);
    } else {
      imported->warnings.push_back("the recorded ultrasound cannot be read and is left out: " +
                                   with_ultrasound.error().text());
    }
  }
  draft.imported = std::move(imported);
  return draft;
}

namespace {
namespace fs = std::filesystem;

/// The patient to write. Copies the volumes once, during the saving.
anatomy::VirtualPatient patient_of(const CaseDraft& draft, DraftPatient& patients) {
  anatomy::VirtualPatient patient = *patients.of(draft);
  patient.name = draft.name;
  patient.description = draft.description;
  patient.provenance = draft.provenance;
  patient.landmarks = draft.landmarks;
  patient.paths = draft.paths;
  return patient;
}

std::optional<io::RecordedUltrasound> ultrasound_of(const CaseDraft& draft) {
  if (!draft.ultrasound) return std::nullopt;
  io::RecordedUltrasound ultrasound{draft.ultrasound->gray_U, draft.ultrasound->fields, {}, {}};
  if (draft.placement) ultrasound.X_PU = draft.placement->X_PU;
  for (const registration::NamedPoint& point : draft.ultrasound_landmarks)
    ultrasound.landmarks_U.push_back({point.name, point.p});
  return ultrasound;
}

Status check_target(const SaveOptions& options) {
  const fs::path& folder = options.folder;
  if (folder.empty()) return fail_usage("no folder given", {}, "choose a folder for the case");
  std::error_code ignored;
  if (!fs::exists(folder, ignored) || fs::is_empty(folder, ignored)) return {};
  if (!fs::exists(folder / "patient.toml", ignored))
    return fail_usage("the folder contains data other than a patient", folder.string(), "choose another folder");
  if (!options.overwrites)
    return fail_usage("a case already exists there", folder.string(),
                      "choose another folder, or confirm that it is replaced");
  return {};
}

/// Replaces the old folder by the new one, and restores the old one on failure.
Status replace(const fs::path& fresh, const fs::path& folder) {
  const fs::path old = folder.parent_path() / fmt::format(".{}.old", folder.filename().string());
  std::error_code error;
  fs::remove_all(old, error);
  fs::rename(folder, old, error);
  if (!error) fs::rename(fresh, folder, error);
  if (error) {
    std::error_code ignored;
    if (!fs::exists(folder, ignored)) fs::rename(old, folder, ignored);
    fs::remove_all(fresh, ignored);
    return fail("the case cannot be replaced: " + error.message(), folder.string(), "choose another folder");
  }
  fs::remove_all(old, error);
  return {};
}

}  // namespace

Status save_case(const CaseDraft& draft, DraftPatient& patients, const SaveOptions& options, const Progress& progress) {
  if (!draft.imported) return fail_usage("there is nothing to save", {}, "import a CT with its labels first");
  if (draft.name.empty()) return fail_usage("the case has no name", {}, "give it one");
  TROCAR_TRY_STATUS(check_target(options));
  const anatomy::VirtualPatient patient = patient_of(draft, patients);
  const image::RgbImage thumbnail = slices::make_slice_thumbnail(patient, slices::find_thumbnail_region(patient));
  std::vector<io::PatientExtra> extras{{tasks::kOwnTaskFile, tasks::task_to_toml(draft.task, draft.base)},
                                       {io::kThumbnailFile, png::encode_png(thumbnail)}};
  if (!draft.imported->own_tissues.empty()) extras.push_back({cases::kOwnTissueFile, draft.imported->own_tissues});
  const std::optional<io::RecordedUltrasound> ultrasound = ultrasound_of(draft);
  const auto write = [&](const fs::path& to) {
    return io::save_patient(patient, *draft_meshes(draft), to, progress, extras, ultrasound ? &*ultrasound : nullptr);
  };
  const fs::path folder = fs::absolute(options.folder).lexically_normal();
  const fs::path target = folder.has_filename() ? folder : folder.parent_path();
  std::error_code ignored;
  fs::create_directories(target.parent_path(), ignored);  // an error is reported when writing
  if (!fs::exists(target / "patient.toml", ignored)) return write(target);
  const fs::path fresh = target.parent_path() / fmt::format(".{}.new", target.filename().string());
  fs::remove_all(fresh, ignored);
  TROCAR_TRY_STATUS(write(fresh));
  return replace(fresh, target);
}

}  // namespace trocar::case_builder
