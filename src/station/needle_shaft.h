#pragma once

#include <vector>

#include "geometry/pose.h"
#include "telemetry/tick_sample.h"

namespace trocar {

/// The device's needle of a tick: X_PN, or X_PT of a transducer.
Pose device_pose(const TickSample& sample) noexcept;
/// The felt one: tip and axis of the virtual needle, the device's roll.
Pose felt_needle(const TickSample& sample) noexcept;
/// The same of a transducer, whose axis is y of T.
Pose felt_probe(const TickSample& sample) noexcept;

/// Points of the shaft in P, hub first, tip last; two while it is straight. A tick tells the tip, the direction there,
/// and how the grip is held: between them runs the curve of a slender beam that is clamped so at both ends (a cubic).
/// The hub lies on the grip's axis where the felt tip leaves it: behind the device's own by the lag. Of the beam's bed
/// it knows nothing; within kShaftBends_mm of the straight line between hub and tip it is drawn straight.
std::vector<Vec3> needle_shaft(const TickSample& sample, double length_mm);
inline constexpr double kShaftBends_mm = 0.05;

}  // namespace trocar
