#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>

#include "case_builder/case_draft.h"
#include "core/progress.h"
#include "core/result.h"
#include "registration/ct_ultrasound/landmark_fit.h"

namespace trocar::case_builder {

/// The recorded ultrasound of a case: a volume, landmarks that it shares with the CT, and its pose in the CT. Edits
/// return a copy of the draft with one change, or an error; the input is not modified. Frames: U of the volume, P.

/// A file of gray levels 0..255.
struct UltrasoundRequest {
  std::filesystem::path file;
  std::string beam_axis;  ///< "+x" to "-z"; empty: the beams of the header, else +y.
};

/// Reads a volume, or makes one of a tracked sweep, with a warning that says so. Errors: the file, its values, its
/// beams, those of reconstruct_freehand. Takes a second for 100 MB, some seconds for a sweep.
Result<std::shared_ptr<const ImportedUltrasound>> read_ultrasound(const UltrasoundRequest& request,
                                                                  const Progress& progress = {});

/// Middle of the volume, in U.
Vec3 middle_of(const ImportedUltrasound& ultrasound);

/// Adds the ultrasound of a patient folder (io/patient/patient_folder.h), if it has one. Errors: its files.
Result<CaseDraft> add_saved_ultrasound(CaseDraft draft, const std::filesystem::path& folder);

/// Sets the volume; landmarks and pose of another one are removed.
CaseDraft set_ultrasound(CaseDraft draft, std::shared_ptr<const ImportedUltrasound> ultrasound);
/// Removes volume, landmarks and pose; the task uses the simulated ultrasound again.
CaseDraft remove_ultrasound(CaseDraft draft);

/// Adds a landmark inside the ultrasound, or moves the one of that name. It is paired with the case's landmark of the
/// same name. Errors: no ultrasound, no name, a point outside the volume.
Result<CaseDraft> set_ultrasound_landmark(CaseDraft draft, const std::string& name, const Vec3& p_U);
Result<CaseDraft> remove_ultrasound_landmark(CaseDraft draft, const std::string& name);
/// Fit of the landmark pairs (registration/ct_ultrasound/landmark_fit.h). Errors: those of fit_landmarks.
Result<registration::LandmarkFit> fit_of_landmarks(const CaseDraft& draft);
/// Places the ultrasound by its landmark pairs. Errors: those of fit_landmarks.
Result<CaseDraft> place_by_landmarks(CaseDraft draft);

/// First pose of the optimisation.
enum class RegistrationStart : std::uint8_t {
  kCurrent,  ///< The present pose of the ultrasound, from landmarks or an earlier registration.
  kHeader,   ///< The volume's own frame is that of the CT.
  kSearch    ///< Search: the transducer may be anywhere on the skin.
};
/// Finds the pose by mutual information (docs/physics.md R11 to R13). Takes seconds: run it in the background. Errors:
/// no ultrasound, no pose to start from, those of register_rigid, a low confidence, `stop`.
Result<UltrasoundPlacement> find_placement(const CaseDraft& draft, RegistrationStart start,
                                           const Progress& progress = {}, const std::stop_token& stop = {});

/// Chooses whether trainees get the recorded ultrasound. Error: it has no pose yet.
Result<CaseDraft> use_recorded_ultrasound(CaseDraft draft, bool is_used);
bool uses_recorded_ultrasound(const CaseDraft& draft) noexcept;

}  // namespace trocar::case_builder
