#pragma once

#include "haptics/contact.h"
#include "haptics/haptic_scene.h"
#include "haptics/insertion.h"
#include "haptics/resting_anatomy.h"
#include "telemetry/tick_sample.h"

namespace trocar {

/// What the device gives a tick.
struct HapticInput {
  double time_s = 0.0;
  double dt_s = 0.001;  ///< Since the last tick; 0 < dt <= kMaxDt_s.
  Pose X_DS;            ///< Stylus in the device base.
  bool is_stylet_in = true;
  RestingAnatomy resting;  ///< The patient's motion now.
};

/// All that a tick carries to the next one. Fixed size, copyable: recorded inputs replay to the same bits.
struct HapticState {
  InsertionState insertion;
  ContactState contact;  ///< Of a transducer or a finger.
  TickSample last;
};

/// What a tick gives: the wrench for the device (in D, about the stylus origin) and its record.
struct HapticOutput {
  Vec3 f_D = Vec3::Zero();
  Vec3 tau_D = Vec3::Zero();
  TickSample sample;
};

inline constexpr double kMaxDt_s = 0.1;

/// One haptic tick: pose into P, needle insertion, path constraint, weight compensation, composition (paper A, force
/// composition; physics.md T1), limits of the device. Pure: a function of its arguments only. Input that is not finite
/// or has an impossible dt gives zero force and a limit event, and leaves the state as it was. Real-time safe.
HapticOutput tick(HapticState& state, const HapticInput& input, const HapticScene& scene) noexcept;

}  // namespace trocar
