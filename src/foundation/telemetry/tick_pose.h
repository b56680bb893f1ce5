#pragma once

#include "geometry/pose.h"
#include "telemetry/tick_sample.h"

namespace trocar::telemetry {

/// Pose of the device's tool at a tick: X_PN, or X_PT of a transducer. Without a rotation: identity rotation.
Pose device_pose(const TickSample& sample) noexcept;
/// Pose of the virtual needle: its tip and axis, with the device's roll.
Pose felt_needle(const TickSample& sample) noexcept;
/// How far (mm, >= 0) the device is ahead of the inserted virtual needle along its axis: tissue pressed in, and the
/// coupling. 0 outside and on unpierced skin.
double pressed_mm(const TickSample& sample) noexcept;
/// Pose of the virtual transducer, whose axis is y of T.
Pose felt_probe(const TickSample& sample) noexcept;

}  // namespace trocar::telemetry
