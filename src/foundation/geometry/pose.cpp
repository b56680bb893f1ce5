#include "geometry/pose.h"

#include <cmath>

namespace trocar {
inline namespace geometry {

Mat3 rotation_between(const Vec3& from, const Vec3& to) noexcept {
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

Pose needle_pose(const Vec3& tip_A, const Vec3& axis_A) noexcept {
  return {rotation_between(Vec3::UnitZ(), axis_A.normalized()), tip_A};
}

double angle_between_rad(const Vec3& a, const Vec3& b) noexcept {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace geometry
}  // namespace trocar
