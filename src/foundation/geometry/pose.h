#pragma once

#include <array>

#include "geometry/vec.h"

namespace trocar {
inline namespace geometry {

/// Rigid transform X_AB: the pose of frame B in frame A; maps points of B to A. Translation in mm. Real-time safe.
/// Invariant: the rotation is orthonormal with determinant +1.
class Pose {
 public:
  Pose() = default;  ///< Identity.
  Pose(const Mat3& R_AB, const Vec3& p_AB) noexcept : R_(R_AB), p_(p_AB) {}
  static Pose translation(const Vec3& p_AB) noexcept { return {Mat3::Identity(), p_AB}; }

  const Mat3& R() const noexcept { return R_; }
  const Vec3& p() const noexcept { return p_; }

  Pose inverse() const noexcept { return {R_.transpose(), -(R_.transpose() * p_)}; }
  Pose operator*(const Pose& X_BC) const noexcept { return {R_ * X_BC.R_, R_ * X_BC.p_ + p_}; }
  Vec3 operator*(const Vec3& p_BQ) const noexcept { return R_ * p_BQ + p_; }

  bool is_finite() const noexcept { return R_.allFinite() && p_.allFinite(); }

 private:
  Mat3 R_ = Mat3::Identity();
  Vec3 p_ = Vec3::Zero();
};

/// Rotation vector: axis times angle (rad, 0..pi) of a rotation. Real-time safe.
Vec3 rotation_vector(const Mat3& R) noexcept;
/// The rotation by |v| rad about v; zero gives identity. Real-time safe.
Mat3 rotation_from_vector(const Vec3& v) noexcept;

/// The shortest rotation that turns the unit vector `from` into the unit vector `to`.
Mat3 rotation_between(const Vec3& from, const Vec3& to) noexcept;

/// Pose X_AN of a needle with its tip at `tip_A` and its axis (hub to tip, unit) along `axis_A`; the roll is that of
/// the shortest rotation from +z to the axis.
Pose needle_pose(const Vec3& tip_A, const Vec3& axis_A) noexcept;

/// Angle between two directions, 0..pi rad.
double angle_between_rad(const Vec3& a, const Vec3& b) noexcept;

}  // namespace geometry
inline namespace geometry {

/// The components of a quaternion in the order w, x, y, z, as in stored records. Real-time safe.
inline std::array<double, 4> to_wxyz(const Eigen::Quaterniond& q) noexcept {
  return {q.w(), q.x(), q.y(), q.z()};
}

/// The quaternion of stored components; not normalised. Real-time safe.
inline Eigen::Quaterniond from_wxyz(const std::array<double, 4>& wxyz) noexcept {
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

}  // namespace geometry
}  // namespace trocar
