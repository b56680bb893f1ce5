#pragma once

#include <vector>

#include "anatomy/build_patient.h"

namespace trocar::anatomy {

/// By how much ranges are widened on both sides.
struct HuMargin {
  double hu = 0.0;     ///< Of the mean.
  double share = 0.0;  ///< Of the voxels that are gas or bone.
};

/// Labels with a mean HU, or a share of gas or bone, that is implausible for their tissue. Ranges are wide; small
/// labels are not checked. `judged_count`: how many were.
std::vector<Finding> find_implausible_hu(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics,
                                         std::size_t* judged_count = nullptr, const HuMargin& margin = {});

}  // namespace trocar::anatomy
