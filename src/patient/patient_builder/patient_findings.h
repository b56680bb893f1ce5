#pragma once

#include <vector>

#include "anatomy/label_statistics.h"

namespace trocar::patient_builder {

/// Findings about the quality of a patient, one line each: coarse voxels, labels with implausible HU, listed labels
/// without voxels, structures cut off at the edge of the scan.
std::vector<anatomy::Finding> patient_findings(const anatomy::VirtualPatient& patient,
                                               const std::vector<anatomy::LabelStatistics>& statistics);
/// These and the slower ones of segmentation_findings.
std::vector<anatomy::Finding> all_patient_findings(const anatomy::VirtualPatient& patient,
                                                   const std::vector<anatomy::LabelStatistics>& statistics);

}  // namespace trocar::patient_builder
