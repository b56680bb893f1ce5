#pragma once

#include "geometry/pose.h"
#include "telemetry/tick_sample.h"

namespace trocar::telemetry {

/// Pose of the device's tool at a tick: X_PN, or X_PT of a transducer. Without a rotation: identity rotation.
Pose device_pose(const TickSample& sample) noexcept;
/// Pose of the virtual needle: its tip and axis, with the device's roll.
Pose felt_needle(const TickSample& sample) noexcept;
/// Where a needle is placed after an interruption, so that it goes on where it was (physics.md S1): the virtual
/// needle's pose, and how far its device was ahead of it because tissue was pressed in and the coupling stretched. A
/// tip that presses on a layer is drawn back to that layer's surface, one on unpierced skin to outside it: being placed
/// there pierces neither.
struct NeedlePlace {
  Pose X_PN;
  double pressed_mm = 0.0;  ///< >= 0; 0 outside and on unpierced skin.
};
NeedlePlace needle_place(const TickSample& sample) noexcept;
/// True if the tip is in the body: below the skin, and the skin has given way.
bool is_in_body(const TickSample& sample) noexcept;
/// Where the tip is in the anatomy at rest (A) as far as layers have given way: in front of a layer that it presses in.
Vec3 pierced_rest_tip_mm(const TickSample& sample) noexcept;
/// Pose of the virtual transducer, whose axis is y of T.
Pose felt_probe(const TickSample& sample) noexcept;

}  // namespace trocar::telemetry
