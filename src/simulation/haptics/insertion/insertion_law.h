#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry/vec.h"

namespace trocar::haptics {

/// Force laws of paper A, section 4.1, as printed, or as in docs/physics.md where the paper leaves a choice. Pure,
/// closed form, real-time safe. Forces are resistances: positive pushes the needle out.

/// Coefficients of one layer's loading law.
struct LoadingLaw {
  double stiffness_n_per_mm = 0.0;   ///< k
  double viscosity_ns_per_mm = 0.0;  ///< nu
  double delta_x_mm = 1.0;           ///< Displacement after which a further Voigt element is added; > 0.
};

/// Pre-puncture force (N) of the incremental viscoelastic model at displacement x and velocity v (physics.md P1):
/// x (6 nu v dx + k x^2 + 3 k x dx + 2 k dx^2) / (6 dx^2); zero for x <= 0 and never negative on retreat.
double prepuncture_force_n(double x_mm, double v_mm_per_s, const LoadingLaw& law) noexcept;

/// Static displacement (mm) at which the layer carries `force_n`: the inverse of prepuncture_force_n at v = 0.
double static_displacement_mm(double force_n, const LoadingLaw& law) noexcept;

/// Static tangent stiffness dF/dx (N/mm) at displacement x.
double tangent_stiffness_n_per_mm(double x_mm, const LoadingLaw& law) noexcept;

/// Contact area of the shaft with one tissue in cm^2 (physics.md F1: in mm^2 the friction would be a hundred times too
/// high).
double contact_area_cm2(double radius_mm, double inserted_mm) noexcept;

/// Fluctuation of the friction, -1..1, uniform at its nodes: a seeded function of the travelled distance with
/// correlation length 0.2 mm, independent of the tick rate (physics.md F2).
double friction_noise(std::uint64_t seed, std::uint32_t tissue, double travel_mm) noexcept;

/// Fades out a force as the needle comes to rest: 0 at rest, 1 from 0.5 mm/s (physics.md F2).
inline constexpr double kRestSpeed_mm_per_s = 0.5;
inline double motion_fade(double speed_mm_per_s) noexcept {
  return std::clamp(std::abs(speed_mm_per_s) / kRestSpeed_mm_per_s, 0.0, 1.0);
}

/// Viscous friction of the body proxies as a share of the linear one (physics.md B6): 1 at rest, 1/2 at
/// kThinning_mm_per_s.
inline constexpr double kThinning_mm_per_s = 15.0;  ///< Range 10..100. [assumed]
inline double shear_thinning(double speed_mm_per_s) noexcept {
  return 1.0 / (1.0 + std::abs(speed_mm_per_s) / kThinning_mm_per_s);
}

inline constexpr double kNoiseCorrelation_mm = 0.2;

/// Pulls the needle back to the line of its skin puncture (paper A, path constraint; physics.md C3, C4). Range: m0/d0
/// at most the device's stiffness (checked when the scene is built).
struct PathConstraintParams {
  double force_n = 3.0;      ///< m0: force beyond d0. Range 0..20. [assumed]
  double linear_mm = 3.0;    ///< d0: below it the force grows linearly. Range 0.5..20. [assumed]
  double torque_nmm = 80.0;  ///< n0: torque beyond theta0. Range 0..500. [assumed]
  double linear_rad = 0.1;   ///< theta0. Range 0.01..1. [assumed]
  double fade_mm = 20.0;     ///< s0: depth of the tip from which the constraint acts in full. Range 5..100. [assumed]
};

/// Largest stiffness n0/theta0 (N mm/rad) against turning about the stylus origin. physics.md C3: above it the loop
/// with a light stylus oscillates. [assumed]
inline constexpr double kMostPathTurning_nmm_per_rad = 1500.0;

/// The parameters with theta0 enlarged until n0/theta0 is at most kMostPathTurning_nmm_per_rad; n0 stays as it is.
PathConstraintParams renderable(PathConstraintParams params) noexcept;

/// The path: P on the resting skin, and the unit direction u.
struct PathLine {
  Vec3 origin_P = Vec3::Zero();
  Vec3 direction_P = Vec3::UnitZ();
};

/// Input of the path constraint: the device's needle.
struct NeedleAtPath {
  Vec3 stylus_P = Vec3::Zero();  ///< X' = S, the stylus origin, where the force acts.
  Vec3 axis_P = Vec3::UnitZ();   ///< a, unit: the tip is at S + l a.
  double length_mm = 0.0;        ///< l.
};

/// Depth of the tip along the path: s = u.(PS + l a).
double tip_depth_mm(const PathLine& line, const NeedleAtPath& needle) noexcept;

/// Fade of the constraint with depth, 0 at the skin and 1 from s0 on: t^2 (3 - 2t), t = s/s0.
double path_fade(double depth_mm, const PathConstraintParams& params) noexcept;

/// Energy (N mm) stored at `now`: V = f(s) (U(d) + W(theta)), d = |X_i - X'|, X_i = P + u (u.PX').
double path_energy_nmm(const PathLine& line, const NeedleAtPath& now, const PathConstraintParams& params) noexcept;

/// Minus the gradient of V, force and torque about S. Across the path F = f m(d) (X_i - X'), m = m0 / max(d, d0); Q = f
/// n(theta) theta (a x u)/|a x u|, n = n0 / max(theta, theta0); along the path -f' (U + W) u at the tip, which is zero
/// outside the fade and never points into the body. The parts across the path and Q are evaluated at the pose `ahead`,
/// which damps them; depth and energy are evaluated at `now`. Real-time safe.
Wrench path_constraint(const PathLine& line, const NeedleAtPath& now, const NeedleAtPath& ahead,
                       const PathConstraintParams& params) noexcept;

}  // namespace trocar::haptics
