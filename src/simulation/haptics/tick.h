#pragma once

#include "haptics/contact/contact.h"
#include "haptics/haptic_scene.h"
#include "haptics/insertion/needle_step.h"
#include "motion/patient_motion.h"
#include "telemetry/tick_sample.h"

namespace trocar::haptics {

/// Input of a tick from the device.
struct HapticInput {
  double time_s = 0.0;
  double dt_s = 0.001;       ///< Time since the last tick; kMinDt_s <= dt <= kMaxDt_s.
  telemetry::ToolPose tool;  ///< X_PN or X_PT, see tool_pose().
  bool is_stylet_in = true;
  motion::PatientMotion motion{};  ///< Where the patient is now.
};

/// The scene's tool on a stylus in the room: X_PW * X_WS * X_SN (or X_ST).
telemetry::ToolPose tool_pose(const HapticScene& scene, const Pose& X_WS) noexcept;

/// State from one tick to the next. Fixed size, copyable. Recorded inputs (the sample's time and tool pose) replay to
/// the same bits.
struct HapticState {
  NeedleState needle;
  ContactState contact;  ///< Contact of a transducer or a finger.
  telemetry::TickSample last;
};

/// Output of a tick: wrenches on the stylus in the room (W, about the stylus origin), and the record. Only a server
/// knows the device's frame D.
struct HapticOutput {
  /// Of tissue and path: what the device's limits, less the weight, leave of it. Its torque is given for a device
  /// without torque, too.
  Wrench tissue_W;
  Wrench weight_W;  ///< Carries the weight of links and stylus, before the limits.
  Wrench total_W;   ///< Both, within the device's limits.
  telemetry::TickSample sample;
};

/// Speeds are displacements divided by dt: below, they and the forces are no longer finite. Far below any loop.
/// [assumed]
inline constexpr double kMinDt_s = 1e-6;
inline constexpr double kMaxDt_s = 0.1;
inline constexpr double kFarAway_mm = 5000.0;  ///< Beyond the reach of any device.

/// One haptic tick in P: force model of the scene, which looks tissue up in the anatomy at rest, weight compensation,
/// composition (paper A, force composition; physics.md T1, T2), limits of the device. Pure: a function of its arguments
/// only. Input that is not finite, further than kFarAway_mm or with an impossible dt gives zero force and a limit
/// event, and leaves the state as it was. A start inside the body and a jump cause no force step and add an event.
/// Real-time safe.
HapticOutput tick(HapticState& state, const HapticInput& input, const HapticScene& scene) noexcept;

}  // namespace trocar::haptics
