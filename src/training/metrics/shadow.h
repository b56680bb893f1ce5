#pragma once

#include "anatomy/patient.h"
#include "geometry/pose.h"
#include "metrics/metric.h"

namespace trocar::metrics {

/// The first structure between the transducer's face and a point that ultrasound does not pass: bone, lung, gas;
/// nullptr: none. The beam runs along the scanline of the point's projection into the image plane, in the resting
/// anatomy. `X_PT`: the transducer, `p_P` a point in its field.
const anatomy::Label* find_shadow(const anatomy::VirtualPatient& patient, const ImagePlane& plane, const Pose& X_PT,
                                  const Vec3& p_P);

}  // namespace trocar::metrics
