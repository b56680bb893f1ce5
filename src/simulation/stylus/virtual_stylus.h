#pragma once

#include "geometry/pose.h"
#include "geometry/vec.h"

namespace trocar::stylus {

/// A simulated device in six degrees of freedom: the stylus as a rigid body that moves about its origin S (physics.md
/// H2). Frame P. The inertia is that of a ball, so that there is no gyroscopic torque.
struct VirtualStylusParams {
  double mass_kg = 0.1;          ///< Apparent mass at the stylus. Range 0.01..2.
  double inertia_kg_mm2 = 50.0;  ///< Inertia of stylus and gimbal about S. Range 5..1000. [assumed] 15 kg mm2 for a
                                 ///< stylus of 50 g, 60 mm long; more with motors on the wrist.
  double weight_n = 0.5;         ///< Gravity on links and stylus. Range 0..5.
  /// Distance of the weight's point of action behind S, along -z of S. Range 0..200. 0: balanced.
  double weight_lever_mm = 0.0;
  double viscosity_ns_per_mm = 0.0;     ///< Viscous friction of the arm's joints, at S. Range 0..0.1.
  double turning_viscosity_nmms = 0.0;  ///< Viscous friction of the gimbal. Range 0..1.
  double friction_n = 0.0;              ///< Dry friction of the arm, at S. Range 0..5.
  double turning_friction_nmm = 0.0;    ///< Dry friction of the gimbal. Range 0..20.
};

/// Model of the hand at the stylus: spring and damper in position and orientation, and a mass. All zero: no hand.
struct StylusHold {
  Pose X_PS;                               ///< Target pose of the stylus at the end of the tick.
  Vec3 velocity_P = Vec3::Zero();          ///< Velocity of S in the target pose, mm/s.
  Vec3 angular_velocity_P = Vec3::Zero();  ///< rad/s
  double point_mm = 0.0;            ///< Offset of the held point H: H = S + point_mm along z of S. Range -500..500.
  double stiffness_n_per_mm = 0.0;  ///< At H, like damping, mass and push.
  double damping_ns_per_mm = 0.0;
  double mass_kg = 0.0;              ///< Mass of hand and fingers.
  double turning_nmm_per_rad = 0.0;  ///< Torsional spring.
  double turning_damping_nmms_per_rad = 0.0;
  double inertia_kg_mm2 = 0.0;  ///< Inertia of the fingers about H.
  Vec3 push_n = Vec3::Zero();   ///< A constant force on the stylus, in P.
};

struct VirtualStylusState {
  Pose X_PS;
  Vec3 v_P = Vec3::Zero();  ///< Velocity of S, mm/s.
  Vec3 w_P = Vec3::Zero();  ///< rad/s
};

/// Mean velocities over a tick; the work of the wrench follows from them.
struct StylusMotion {
  Vec3 v_P = Vec3::Zero();  ///< mm/s
  Vec3 w_P = Vec3::Zero();  ///< rad/s
};

/// Moves the stylus by one tick under the hand and the wrench (about S, in P) that acts during it. Exact for constant
/// forces; springs, dampers and friction are implicit: stable for any dt. Friction stops a motion that it can stop
/// within the tick. `gravity_P`: unit, downwards. Real-time safe.
StylusMotion step_stylus(VirtualStylusState& state, const VirtualStylusParams& params, const StylusHold& hold,
                         const Wrench& wrench_P, const Vec3& gravity_P, double dt_s) noexcept;

/// Model of the hand (physics.md H1) with rotational springs about the grip [assumed]: a pen grip of two fingers 30 mm
/// apart. Range 50..1000 N mm/rad.
StylusHold make_hand() noexcept;
/// The same hand guiding the needle at its tip, `tip_mm` before S (physics.md H6).
StylusHold make_guiding_hand(double tip_mm) noexcept;

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

}  // namespace trocar::stylus
