#pragma once

#include <vector>

#include "anatomy/patient.h"
#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {

/// The only landmark inside the body.
inline constexpr const char* kHilumLandmark = "hilum of the liver";

/// Points of the body that can be seen or felt, and the hilum of the liver, inside the anatomy's box (P of the patient,
/// mm).
std::vector<Landmark> find_landmarks(const Anatomy& anatomy);

}  // namespace trocar::anatomy::phantom
