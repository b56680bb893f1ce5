#include "geometry/pose.h"

#include <cmath>

namespace trocar {
inline namespace geometry {

Vec3 rotation_vector(const Mat3& R) noexcept {
  const Eigen::Quaterniond q(R);
  const double sine = q.vec().norm();
  constexpr double kTiny = 1e-12;
  if (!(sine > kTiny)) return 2.0 * q.vec();  // sin of half the angle is half the angle
  const double half = std::atan2(sine, std::abs(q.w()));
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  return q.vec() * (sign * 2.0 * half / sine);
}

Mat3 rotation_from_vector(const Vec3& v) noexcept {
  const double angle = v.norm();
  if (!(angle > 0.0)) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
}

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
