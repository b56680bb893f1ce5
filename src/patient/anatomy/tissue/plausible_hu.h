#pragma once

#include <vector>

#include "anatomy/build_patient.h"

namespace trocar::anatomy {

/// Labels with a mean HU that is implausible for their tissue. If many labels fail, the first line warns
/// that the segmentation may belong to another CT. Ranges are wide; small labels are not checked.
std::vector<Finding> find_implausible_hu(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics);

}  // namespace trocar::anatomy
