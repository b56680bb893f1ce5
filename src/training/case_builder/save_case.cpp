#include "case_builder/save_case.h"

#include <fmt/format.h>

#include "cases/prepare_case.h"
#include "io/patient/patient_folder.h"
#include "io/patient/patient_thumbnail.h"
#include "png/png_file.h"
#include "slices/thumbnail.h"

namespace trocar::case_builder {
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
  const volume::RgbImage thumbnail = slices::make_slice_thumbnail(patient, slices::find_thumbnail_region(patient));
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
