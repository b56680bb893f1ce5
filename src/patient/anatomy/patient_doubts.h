#pragma once

#include <string>
#include <vector>

#include "anatomy/build_patient.h"

namespace trocar::anatomy {

/// What a reader should know before trusting a patient, one line each: coarse voxels, labels whose HU do not fit them,
/// listed labels without a voxel, structures that the edge of the scan cuts off.
std::vector<std::string> find_doubts(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics);

}  // namespace trocar::anatomy
