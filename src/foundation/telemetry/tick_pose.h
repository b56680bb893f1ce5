#pragma once

#include "geometry/pose.h"
#include "telemetry/tick_sample.h"

namespace trocar::telemetry {

/// The device's tool of a tick: X_PN, or X_PT of a transducer. Without a rotation: unturned.
Pose device_pose(const TickSample& sample) noexcept;
/// Virtual needle: its tip and axis, with the device's roll.
Pose felt_needle(const TickSample& sample) noexcept;
/// The same of a transducer, whose axis is y of T.
Pose felt_probe(const TickSample& sample) noexcept;

}  // namespace trocar::telemetry
