#pragma once

#include "geometry/vec.h"

namespace trocar {

/// Holds the needle on the line it pierced the skin along (paper A, path constraint; physics.md C3, C4).
/// Range: m0/d0 at most the device's stiffness (checked when the scene is built).
struct PathConstraintParams {
  double force_n = 3.0;      ///< m0: force beyond d0. Range 0..20. [assumed]
  double linear_mm = 3.0;    ///< d0: below it the force grows linearly. Range 0.5..20. [assumed]
  double torque_nmm = 80.0;  ///< n0: torque beyond theta0. Range 0..500. [assumed]
  double linear_rad = 0.1;   ///< theta0. Range 0.01..1. [assumed]
};

/// A pull on the needle in P.
struct Wrench {
  Vec3 force_n = Vec3::Zero();
  Vec3 torque_nmm = Vec3::Zero();
};

/// F = m(d) (u |PX'| - PX'), m = m0 / max(d, d0); Q = n(theta) theta (axis x u)/|axis x u|, n = n0 / max(theta,
/// theta0). `origin_P`: contact point P on the skin; `direction_P`: unit u of the path; `tip_P`: X', the device's tip;
/// `axis_P`: unit axis of the device's needle. Zero at d = 0 and theta = 0. Real-time safe.
Wrench path_constraint(const Vec3& origin_P, const Vec3& direction_P, const Vec3& tip_P, const Vec3& axis_P,
                       const PathConstraintParams& params) noexcept;

}  // namespace trocar
