#pragma once

#include <vector>

#include "telemetry/tick_sample.h"

namespace trocar::attempt {

/// Points of the shaft in P, hub first, tip last; two points for a straight shaft. A tick contains the tip, the
/// direction there, and the pose of the grip. The curve between them is that of a slender beam clamped at both ends (a
/// cubic). The hub lies on the grip's axis, behind the device's own hub by the lag of the felt tip. The curve does not
/// model the bed of the beam. A shaft within kShaftBends_mm of the straight line between hub and tip is drawn straight.
std::vector<Vec3> needle_shaft(const telemetry::TickSample& sample, double length_mm);
inline constexpr double kShaftBends_mm = 0.05;

/// Returns the shaft without its last `inside_mm`, the part in the body. Empty if the whole shaft is in the body.
std::vector<Vec3> shaft_outside(std::vector<Vec3> shaft_P, double inside_mm);

}  // namespace trocar::attempt
