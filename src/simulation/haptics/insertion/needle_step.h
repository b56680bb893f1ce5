#pragma once

#include "haptics/insertion/insertion.h"
#include "haptics/insertion/insertion_path.h"
#include "haptics/proxy/body_proxies.h"
#include "haptics/proxy/proxy_needle.h"

namespace trocar::haptics {

/// The needle under any force model, from one tick to the next. Fixed size.
struct NeedleState {
  bool is_started = false;
  Pose X_PN;                           ///< Device's needle at the last tick, in the resting anatomy.
  Vec3 tip_velocity_P = Vec3::Zero();  ///< mm/s, and
  Vec3 axis_rate_P = Vec3::Zero();     ///< 1/s, of the device's needle, smoothed: counts of its encoders would ripple.
  InsertionPath path;
  InsertionState insertion;  ///< Insertion and combined.
  ProxyNeedleState proxy;    ///< Proxy.
  BentNeedle shape;          ///< For pictures, ultrasound and X-ray.
};

/// What a step of the needle gives, in P, before weight and limits (physics.md T1, T2).
struct NeedleStep {
  InsertionStep axial;
  Wrench held_P;                    ///< Path constraint, or the body proxies: force, and torque about the grip.
  Vec3 tip_proxy_P = Vec3::Zero();  ///< Force of the tip proxy on the needle.
  bool has_resumed = false;         ///< Was found inside the body and taken as inserted.
  bool has_jumped = false;          ///< The device moved further than a hand can: started afresh.
};

/// One step of the needle at the pose X_PN (resting anatomy) under the scene's force model. Real-time safe.
NeedleStep step_needle(NeedleState& state, const HapticScene& scene, const Pose& X_PN, bool is_stylet_in,
                       double dt_s) noexcept;

}  // namespace trocar::haptics
