#include "case_builder/ultrasound.h"

#include <fmt/format.h>

#include <algorithm>

#include "case_builder/case_draft.h"
#include "core/result.h"
#include "io/image/image_file.h"
#include "io/markups_file.h"
#include "io/patient/patient_extras.h"
#include "io/sequence/sequence_file.h"
#include "io/sequence/transform_file.h"
#include "registration/ct_ultrasound/rigid_registration.h"
#include "registration/intensity/gray_levels.h"
#include "registration/shadow/shadow_mask.h"
#include "ultrasound/sweep/freehand.h"

namespace trocar::case_builder {
namespace fs = std::filesystem;
namespace {

constexpr const char* kRecorded = "panorama";
constexpr const char* kSimulated = "raycast";
constexpr double kReach_mm = 15.0;  ///< From the present pose, as from landmarks in `trocar register`.

auto find_ultrasound_landmark(std::vector<registration::NamedPoint>& landmarks, const std::string& name) {
  return std::find_if(landmarks.begin(), landmarks.end(), [&](const auto& point) { return point.name == name; });
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

Status check_volume(const CaseDraft& draft) {
  if (draft.ultrasound) return {};
  return fail("the case has no recorded ultrasound", {}, "read an ultrasound volume first");
}

/// In the sweep's reference frame, with the settings that the command has without a calibration file.
Result<volume::LabelGrid> volume_of_sweep(const fs::path& file, std::vector<std::string>& warnings,
                                          const Progress& progress) {
  TROCAR_TRY(const ultrasound::TrackedSequence sequence, io::read_sequence(file));
  ultrasound::FreehandOptions options;
  options.holes = {ultrasound::HoleFilling{}};
  options.is_black_left_out = true;
  auto made = ultrasound::reconstruct_freehand(sequence, {}, options, progress);
  if (!made)
    return fail("a tracked sweep, of which no volume can be made: " + made.error().what, file.string(),
                made.error().advice + "; trocar ultrasound reconstruct takes a calibration file");
  warnings.push_back(fmt::format(
      "a tracked sweep: a volume of {:g} mm was reconstructed from {} images; choose the direction of its beams",
      made->gray.geometry.spacing_mm[0], made->frames_used));
  return std::move(made->gray);
}

}  // namespace

Result<std::shared_ptr<const ImportedUltrasound>> read_ultrasound(const UltrasoundRequest& request,
                                                                  const Progress& progress) {
  if (request.file.empty()) return fail("no ultrasound given", {}, "choose a volume of gray levels");
  auto read = std::make_shared<ImportedUltrasound>();
  read->source = request.file.string();
  TROCAR_TRY(const bool is_sweep, io::is_sequence(request.file));
  if (is_sweep) {
    TROCAR_TRY(read->gray_U, volume_of_sweep(request.file, read->warnings, progress));
  } else {
    TROCAR_TRY(read->gray_U, io::read_gray_levels(request.file, read->warnings));
    TROCAR_TRY(read->fields, io::read_image_fields(request.file));
  }
  auto beams = registration::Beams::choose(request.beam_axis, read->fields, read->gray_U.geometry);
  if (!beams) return fail_at(read->source, beams.error());
  read->beams = *beams;
  read->white = registration::bright_gray(read->gray_U);
  read->imaged_U = registration::imaged_voxels(read->gray_U, read->beams);
  if (!request.beam_axis.empty()) {  // the chosen beams, when the saved case is read again
    read->fields.erase("trocar_apex_mm");
    read->fields.insert_or_assign("trocar_beam_axis", request.beam_axis);
  }
  return read;
}

Vec3 middle_of(const ImportedUltrasound& ultrasound) {
  const volume::GridGeometry& grid = ultrasound.gray_U.geometry;
  return grid.to_mm(0.5 * (volume::to_vec3(grid.size) - Vec3::Ones()));
}

Result<CaseDraft> add_saved_ultrasound(CaseDraft draft, const fs::path& folder) {
  if (!is_file(folder / io::kPanoramaFile)) return draft;
  TROCAR_TRY(draft.ultrasound, read_ultrasound({folder / io::kPanoramaFile, {}}));
  if (is_file(folder / io::kPanoramaTransformFile)) {
    TROCAR_TRY(const Pose X_PU, io::read_transform(folder / io::kPanoramaTransformFile));
    draft.placement = UltrasoundPlacement{X_PU, PlacementOrigin::kSaved, 0.0};
  }
  if (!is_file(folder / io::kPanoramaLandmarkFile)) return draft;
  TROCAR_TRY(const auto landmarks, io::read_landmarks(folder / io::kPanoramaLandmarkFile));
  for (const anatomy::Landmark& landmark : landmarks)
    draft.ultrasound_landmarks.push_back({landmark.name, landmark.p_P});
  return draft;
}

CaseDraft set_ultrasound(CaseDraft draft, std::shared_ptr<const ImportedUltrasound> ultrasound) {
  draft = remove_ultrasound(std::move(draft));
  draft.ultrasound = std::move(ultrasound);
  return draft;
}

CaseDraft remove_ultrasound(CaseDraft draft) {
  draft.ultrasound.reset();
  draft.ultrasound_landmarks.clear();
  draft.placement.reset();
  draft.task.ultrasound_engine = kSimulated;
  return draft;
}

Result<CaseDraft> set_ultrasound_landmark(CaseDraft draft, const std::string& name, const Vec3& p_U) {
  TROCAR_TRY_STATUS(check_volume(draft));
  if (name.empty()) return fail("a landmark needs a name", {}, "choose or type one");
  TROCAR_TRY_STATUS(detail::check_in_volume(draft.ultrasound->gray_U.geometry, p_U, "landmark of the ultrasound",
                                            "click inside the ultrasound"));
  if (const auto found = find_ultrasound_landmark(draft.ultrasound_landmarks, name);
      found != draft.ultrasound_landmarks.end())
    found->p = p_U;
  else
    draft.ultrasound_landmarks.push_back({name, p_U});
  return draft;
}

Result<CaseDraft> remove_ultrasound_landmark(CaseDraft draft, const std::string& name) {
  const auto found = find_ultrasound_landmark(draft.ultrasound_landmarks, name);
  if (found == draft.ultrasound_landmarks.end())
    return fail("the ultrasound has no such landmark", name, "select one of the list");
  draft.ultrasound_landmarks.erase(found);
  return draft;
}

Result<registration::LandmarkFit> fit_of_landmarks(const CaseDraft& draft) {
  std::vector<registration::NamedPoint> ct;
  for (const anatomy::Landmark& landmark : draft.landmarks) ct.push_back({landmark.name, landmark.p_P});
  return registration::fit_landmarks(ct, draft.ultrasound_landmarks);
}

Result<CaseDraft> place_by_landmarks(CaseDraft draft) {
  TROCAR_TRY_STATUS(check_volume(draft));
  TROCAR_TRY(const registration::LandmarkFit fit, fit_of_landmarks(draft));
  draft.placement = UltrasoundPlacement{fit.fit.X_AB, PlacementOrigin::kLandmarks, 0.0};
  return draft;
}

Result<UltrasoundPlacement> find_placement(const CaseDraft& draft, RegistrationStart start, const Progress& progress,
                                           const std::stop_token& stop) {
  TROCAR_TRY_STATUS(check_volume(draft));
  registration::RigidOptions options;
  options.is_search = start == RegistrationStart::kSearch;
  options.is_cancelled = [&stop] { return stop.stop_requested(); };
  if (start == RegistrationStart::kCurrent) {
    if (!draft.placement)
      return fail("the ultrasound has no pose to start from", {}, "fit the landmarks, or choose another start");
    options.X_CU = draft.placement->X_PU;
    options.reach_mm = kReach_mm;
  }
  TROCAR_TRY(const registration::RigidRegistration found,
             registration::register_rigid(draft.imported->patient.ct, draft.ultrasound->gray_U, draft.ultrasound->beams,
                                          options, progress));
  TROCAR_TRY_STATUS(registration::check_confidence(found, "the pose was not changed"));
  return UltrasoundPlacement{found.X_CU, PlacementOrigin::kOptimised, found.confidence};
}

Result<CaseDraft> use_recorded_ultrasound(CaseDraft draft, bool is_used) {
  if (is_used && !draft.placement)
    return fail("the recorded ultrasound has no pose in the CT yet", {}, "fit landmarks or register it first");
  draft.task.ultrasound_engine = is_used ? kRecorded : kSimulated;
  return draft;
}

bool uses_recorded_ultrasound(const CaseDraft& draft) noexcept {
  return draft.task.ultrasound_engine == kRecorded;
}

}  // namespace trocar::case_builder
