#pragma once

#include <string>
#include <vector>

#include "anatomy/build_patient.h"

namespace trocar::anatomy {

/// Labels whose mean HU no tissue of their kind has, one line each: bone that is soft, lung that is solid, a liver of
/// air. Where that holds for many of them, a line that the segmentation may belong to another CT comes first.
/// Ranges are wide (plain and contrast-enhanced, averaged over partial volume); small labels are not judged.
std::vector<std::string> find_implausible_hu(const VirtualPatient& patient,
                                             const std::vector<LabelStatistics>& statistics);

}  // namespace trocar::anatomy
