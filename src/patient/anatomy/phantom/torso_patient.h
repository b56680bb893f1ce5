#pragma once

#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/phantom/cases.h"
#include "anatomy/phantom/structure.h"
#include "core/result.h"

namespace trocar::anatomy::phantom {

/// What a case adds to the volumes (P of the patient, mm).
struct TorsoPlan {
  std::vector<Landmark> landmarks;
  std::vector<NeedlePath> paths;  ///< Expert paths of the case's task.
  std::string finding;            ///< "lesion of 24 mm in segment VI of the liver"; may be empty.
};

/// Fills an empty anatomy with a torso from T8 to the sacrum for a case. Errors: no safe path for the task in this
/// body; an unknown structure name.
Result<TorsoPlan> build_torso(Anatomy& anatomy, const CaseDescription& description);

}  // namespace trocar::anatomy::phantom
