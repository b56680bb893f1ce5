#pragma once

#include "haptics/insertion/insertion.h"
#include "haptics/insertion/insertion_path.h"
#include "haptics/proxy/body_proxies.h"
#include "haptics/proxy/proxy_needle.h"
#include "telemetry/needle_shape.h"

namespace trocar::haptics {

/// Rotational stiffness of the shaft's bed at the grip at the last depth of the tip, and its change per mm of depth.
struct GripTurning {
  double tip_mm = 0.0;
  double nmm_per_rad = 0.0;
  double slope = 0.0;
};

/// State of the needle under any force model, from one tick to the next. Fixed size.
struct NeedleState {
  bool is_started = false;
  double pressed_mm = 0.0;  ///< Before the start: how far the tissue gives way again (start_insertion).
  Pose X_PN;                ///< Device's needle at the last tick.
  /// Velocity of the device's needle tip, mm/s, smoothed against ripple from encoder counts.
  Vec3 tip_velocity_P = Vec3::Zero();
  Vec3 axis_rate_P = Vec3::Zero();  ///< Rate of the device's needle axis, 1/s, smoothed likewise.
  InsertionPath path;
  InsertionState insertion;  ///< Used by the insertion and combined models.
  ProxyNeedleState proxy;    ///< Used by the proxy model.
  BentShaft bent;            ///< See needle_shape.
  GripTurning turning;
  bool is_torn = false;  ///< Bent further than any needle bends: it leaves its channel.
};

/// Result of a step of the needle, in P, before weight and limits (physics.md T1, T2).
struct NeedleStep {
  InsertionStep axial;
  Wrench held_P;  ///< Wrench of the path constraint or of the body proxies: force, and torque about the grip.
  Vec3 tip_proxy_P = Vec3::Zero();  ///< Force of the tip proxy on the needle.
  bool has_resumed = false;         ///< The needle was inside the body and is treated as inserted.
  bool has_jumped = false;          ///< The device moved further than a hand can; the needle restarted.
};

/// One step of the needle at the pose X_PN under the scene's force model. Real-time safe.
NeedleStep step_needle(NeedleState& state, const PatientNow& now, const Pose& X_PN, bool is_stylet_in,
                       double dt_s) noexcept;

/// Shape of the shaft after a step, for display, ultrasound and X-ray, without its time. Where paper A's path
/// constraint acts, which knows no bending, the shape is that of the same beam in the same bed, without a force on the
/// bevel. Real-time safe; cheap enough for 100 Hz.
telemetry::NeedleShape needle_shape(const NeedleState& state, const PatientNow& now, bool is_stylet_in) noexcept;

}  // namespace trocar::haptics
