#pragma once

#include "anatomy/patient.h"
#include "metrics/metric.h"
#include "ultrasound/probe/transducer.h"
#include "xray/contrast/vessel_streak.h"

namespace trocar::cases {

/// Image plane of a transducer at an image depth (mm).
metrics::ImagePlane image_plane(const ultrasound::Transducer& transducer, double depth_mm);

/// The blood of a patient's vessels (data/flow.toml), which carries contrast agent along; follows the vessels first,
/// which takes seconds. Empty, with a line in the log, where no vessel has flow.
xray::BloodVelocity contrast_blood(const anatomy::VirtualPatient& patient);

}  // namespace trocar::cases
