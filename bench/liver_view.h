#pragma once

#include <optional>

#include "anatomy/patient.h"
#include "geometry/pose.h"
#include "ultrasound/scan_geometry.h"

namespace trocar::bench {

/// Pose X_PT on the skin from which most of the picture's middle depths are liver, found by search. Deterministic.
/// Nothing where no structure's tissue is liver or no place shows it.
std::optional<Pose> find_liver_view(const VirtualPatient& patient, const ScanGeometry& scan);

}  // namespace trocar::bench
