#pragma once

#include "geometry/pose.h"
#include "tasks/operator.h"

namespace trocar::tasks {

/// The hand that holds the stylus: a second-order lump (mass, spring, damper) between the operator's wanted needle
/// position and the device's needle position; docs/physics.md, hand. Form: Speich, Shao, Goldfarb 2005, Mechatronics
/// 15:1127 (the usual model of a human on a haptic handle is a second order mass-spring-damper; more elements gain
/// little in some cases). Stiffness and damping grow with the grip: Hasser, Cutkosky 2002; stylus grips of 1..3 N on a
/// Phantom Premium 1.5: Fu, Cavusoglu 2012. The numbers here are [assumed]: no table of these papers could be read. A
/// hand with a firmer grip (HandCommand::grip) has the same damping ratio.
struct HandParams {
  double mass_kg = 0.15;             ///< Mass of hand and fingers that moves with the stylus. Range 0.02..2. Assumed.
  double stiffness_n_per_mm = 0.6;   ///< Range 0.05..5. Assumed: 2.8 N at the skin press the grip in by 4.7 mm.
  double damping_ns_per_mm = 0.012;  ///< Range 0.0005..0.1. Assumed: damping ratio 0.63 of the hand alone.
  double turning_time_constant_s = 0.08;  ///< The stylus follows the wanted orientation. Range 0.005..1. Assumed.
};

/// The hand in the form for an integrator: f_P = stiffness*(anchor - tip) + damping*(anchor velocity - velocity) on a
/// mass that is added to the device's. The derivatives by position and velocity are -stiffness and -damping.
struct HandSpring {
  Vec3 anchor_P = Vec3::Zero();           ///< Target position of the tip, mm.
  Vec3 anchor_velocity_P = Vec3::Zero();  ///< mm/s.
  double stiffness_n_per_mm = 0.0;
  double damping_ns_per_mm = 0.0;
  double mass_kg = 0.0;
};
HandSpring hand_spring(const HandParams& hand, const HandCommand& command) noexcept;

/// Force of the hand on the stylus, N in P, with the needle at X_PN_device moving with v_P (mm/s). Real-time safe.
Vec3 hand_force_n(const HandParams& hand, const HandCommand& command, const Pose& X_PN_device,
                  const Vec3& v_P) noexcept;

/// Orientation of the device's needle dt_s later: R_PN turned towards R_PN_wanted the shortest way, the remaining angle
/// shrinks by exp(-dt/time constant) for any step. Real-time safe.
Mat3 follow_rotation(const HandParams& hand, const Mat3& R_PN, const Mat3& R_PN_wanted, double dt_s) noexcept;

}  // namespace trocar::tasks
