#pragma once

#include "geometry/pose.h"

namespace trocar::haptics {

/// A simulated haptic device: the stylus as a point mass with weight, held by the spring of a hand. Forces of the tick
/// act on it one tick late, as on a real device. Frame P throughout; the point is the needle's tip.
struct VirtualDeviceParams {
  double mass_kg = 0.1;   ///< Apparent mass at the stylus, 45-150 g for PHANTOM devices. Range 0.01..2.
  double weight_n = 0.5;  ///< Gravity on links and stylus, as in DeviceCapability. Range 0..5.
};

/// Model of the hand during a tick.
struct HandHold {
  Vec3 anchor_P = Vec3::Zero();           ///< Target position of the tip at the end of the tick.
  Vec3 anchor_velocity_P = Vec3::Zero();  ///< mm/s.
  double stiffness_n_per_mm = 0.0;
  double damping_ns_per_mm = 0.0;
  double mass_kg = 0.0;          ///< Mass of hand and fingers, added to the device's.
  Mat3 R_PN = Mat3::Identity();  ///< Needle's orientation at the end of the tick; the hand turns the needle freely.
};

struct VirtualDeviceState {
  Pose X_PN;
  Vec3 v_P = Vec3::Zero();  ///< mm/s
};

/// Moves the device by one tick under the hand and the force of the last tick. Hand and damping are implicit: stable
/// for any dt. `gravity_P` is the unit vector downwards.
void step_device(VirtualDeviceState& state, const VirtualDeviceParams& params, const HandHold& hand,
                 const Vec3& force_P, const Vec3& gravity_P, double dt_s) noexcept;

}  // namespace trocar::haptics
