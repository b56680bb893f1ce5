#pragma once

#include <vector>

#include "telemetry/tick_sample.h"

namespace trocar::attempt {

/// Points of the shaft in P, hub first, tip last; two while it is straight. A tick tells the tip, the direction there,
/// and how the grip is held: between them runs the curve of a slender beam that is clamped so at both ends (a cubic).
/// The hub lies on the grip's axis where the felt tip leaves it: behind the device's own by the lag. Of the beam's bed
/// it knows nothing; within kShaftBends_mm of the straight line between hub and tip it is drawn straight.
std::vector<Vec3> needle_shaft(const telemetry::TickSample& sample, double length_mm);
inline constexpr double kShaftBends_mm = 0.05;

/// The shaft without its last `inside_mm`, what is in the body; empty: all of it is.
std::vector<Vec3> shaft_outside(std::vector<Vec3> shaft_P, double inside_mm);

}  // namespace trocar::attempt
