#pragma once

#include <string>
#include <vector>

#include "anatomy/patient.h"

namespace trocar::phantom {

/// Contradictions in a generated patient, one line each; empty for a sound one: labels outside the skin or missing
/// inside, free fluid that reaches lung or skin, landmarks off the skin, expert paths that begin off the skin or go
/// through bone, vessel, bowel, lung, kidney or gallbladder for more than a voxel's diagonal.
std::vector<std::string> find_contradictions(const anatomy::VirtualPatient& patient);

}  // namespace trocar::phantom
