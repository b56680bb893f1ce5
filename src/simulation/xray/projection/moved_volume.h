#pragma once

#include <memory>

#include "motion/patient_motion.h"
#include "volume/grid.h"
#include "xray/projection/xray_volume.h"

namespace trocar::xray {

/// The patient as it is now: the volume at rest, in frame A, resampled to P (docs/physics.md X6). Densities are divided
/// by the determinant of the Jacobian, so that a region that is stretched keeps its mass; where regions slide apart or
/// over each other, mass appears or is lost. A patient at rest is `rest` itself. All cores.
std::shared_ptr<const XrayVolume> moved_volume(std::shared_ptr<const XrayVolume> rest,
                                               const motion::PatientMotion& motion);

/// The same for a grid of concentrations, e.g. of contrast agent.
volume::FloatGrid moved_grid(const volume::FloatGrid& rest, const motion::PatientMotion& motion);

}  // namespace trocar::xray
