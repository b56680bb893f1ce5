#pragma once

#include <string>
#include <vector>

#include "anatomy/build_patient.h"

namespace trocar::anatomy {

/// Doubts about the quality of a patient, one line each: coarse voxels, labels with implausible HU, listed labels
/// without voxels, structures cut off at the edge of the scan, and those of find_segmentation_doubts.
std::vector<Finding> find_doubts(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics);

}  // namespace trocar::anatomy
