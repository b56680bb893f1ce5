#include "haptics/path_constraint.h"

#include <algorithm>

#include "geometry/pose.h"

namespace trocar {

Wrench path_constraint(const Vec3& origin_P, const Vec3& direction_P, const Vec3& tip_P, const Vec3& axis_P,
                       const PathConstraintParams& params) noexcept {
  const Vec3 p_PX = tip_P - origin_P;
  const Vec3 restoring = direction_P * p_PX.norm() - p_PX;  // X_i - X'
  const double d = restoring.norm();
  Wrench wrench;
  wrench.force_n = restoring * (params.force_n / std::max(d, params.linear_mm));

  const Vec3 turn = axis_P.cross(direction_P);
  const double sine = turn.norm();
  constexpr double kParallel = 1e-9;
  if (sine > kParallel) {
    const double theta = angle_between_rad(axis_P, direction_P);
    wrench.torque_nmm = turn * (params.torque_nmm * theta / std::max(theta, params.linear_rad) / sine);
  }
  return wrench;
}

}  // namespace trocar
