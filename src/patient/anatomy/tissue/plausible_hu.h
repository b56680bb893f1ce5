#pragma once

#include <vector>

#include "anatomy/build_patient.h"

namespace trocar::anatomy {

/// Labels with a mean HU that is implausible for their tissue. Ranges are wide; small labels are not checked.
/// `judged_count`: how many were. `margin_hu` widens the ranges on both sides.
std::vector<Finding> find_implausible_hu(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics,
                                         std::size_t* judged_count = nullptr, double margin_hu = 0.0);

}  // namespace trocar::anatomy
