#pragma once

#include <vector>

#include "telemetry/needle_shape.h"
#include "telemetry/tick_sample.h"

namespace trocar::attempt {

/// Points of the shaft in P, hub first, tip last; two points for a straight shaft. The shape of the haptic tick on the
/// pose of the device's needle, moved so that its tip is the tick's: behind the device by the lag of the felt tip.
std::vector<Vec3> needle_shaft(const telemetry::TickSample& sample, const telemetry::NeedleShape& shape,
                               double length_mm);

/// Returns the shaft without its last `inside_mm`, the part in the body. Empty if the whole shaft is in the body.
std::vector<Vec3> shaft_outside(std::vector<Vec3> shaft_P, double inside_mm);

}  // namespace trocar::attempt
