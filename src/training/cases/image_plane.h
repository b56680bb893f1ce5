#pragma once

#include "metrics/metric.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::cases {

/// Image plane of a transducer at an image depth (mm).
metrics::ImagePlane image_plane(const ultrasound::Transducer& transducer, double depth_mm);

}  // namespace trocar::cases
