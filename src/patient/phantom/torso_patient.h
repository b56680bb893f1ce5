#pragma once

#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "phantom/cases.h"
#include "phantom/structure.h"

namespace trocar::phantom {

/// What a case adds to the volumes (P of the patient, mm).
struct TorsoPlan {
  std::vector<anatomy::Landmark> landmarks;
  std::vector<anatomy::NeedlePath> paths;  ///< Expert paths of the case's task.
  std::string finding;                     ///< "lesion of 24 mm in segment VI of the liver"; may be empty.
};

/// Fills an empty anatomy with a torso from T8 to the sacrum for a case. Errors: no safe path for the task in this
/// body; an unknown structure name.
Result<TorsoPlan> build_torso(Anatomy& anatomy, const CaseDescription& description);

/// The only landmark inside the body.
inline constexpr const char* kHilumLandmark = "hilum of the liver";

/// Points of the body that can be seen or felt, and the hilum of the liver, inside the anatomy's box (P of the patient,
/// mm).
std::vector<anatomy::Landmark> find_landmarks(const Anatomy& anatomy);

}  // namespace trocar::phantom
