#include "case_builder/import_case.h"

#include <filesystem>

#include "anatomy/phantom/phantom.h"
#include "anatomy/plausibility/judge_anatomy.h"
#include "anatomy/repair/repair_segmentation.h"
#include "case_builder/ultrasound.h"
#include "cases/prepare_case.h"
#include "core/files/atomic_file.h"
#include "core/files/data_dir.h"
#include "core/part_of_progress.h"
#include "io/patient/build_from_files.h"
#include "io/patient/open_patient.h"
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
                                             std::vector<anatomy::AnatomyFinding>& findings, const Progress& progress,
                                             const std::stop_token& stop) {
  if (is_whole_patient(request)) {
    TROCAR_TRY(anatomy::VirtualPatient patient, io::open_patient({request.ct, 1}, progress));
    findings = anatomy::judge_anatomy(patient);
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
  for (const anatomy::PhantomInfo& info : anatomy::embedded_patients())
    if (info.name == request.ct) return true;
  return false;
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
  imported->findings = anatomy::segmentation_findings(imported->patient);

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

}  // namespace trocar::case_builder
