#pragma once

#include <vector>

#include "anatomy/build_patient.h"

namespace trocar::anatomy {

/// Doubts about the quality of a patient, one line each: coarse voxels, labels with implausible HU, listed labels
/// without voxels, structures cut off at the edge of the scan.
std::vector<Finding> find_doubts(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics);
/// These and the slower ones of find_segmentation_doubts.
std::vector<Finding> find_all_doubts(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics);

}  // namespace trocar::anatomy
