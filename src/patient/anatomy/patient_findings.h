#pragma once

#include <vector>

#include "anatomy/build_patient.h"

namespace trocar::anatomy {

/// Findings about the quality of a patient, one line each: coarse voxels, labels with implausible HU, listed labels
/// without voxels, structures cut off at the edge of the scan.
std::vector<Finding> patient_findings(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics);
/// These and the slower ones of segmentation_findings.
std::vector<Finding> all_patient_findings(const VirtualPatient& patient,
                                          const std::vector<LabelStatistics>& statistics);

}  // namespace trocar::anatomy
