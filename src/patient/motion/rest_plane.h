#pragma once

#include <vector>

#include "motion/patient_motion.h"
#include "volume/sampling.h"

namespace trocar::motion {

/// The tissue at the points of a plane, at rest, row by row: for images. Between every fourth point the map is
/// interpolated where the points around belong to one region (for maps that models permit, within 0.05 mm for points up
/// to 1 mm apart), else exact. One thread; allocates only if the plane is larger than the last one.
void rest_of_plane(const PatientMotion& motion, const volume::SlicePlane& plane, std::vector<Vec3f>& rest_A);

}  // namespace trocar::motion
