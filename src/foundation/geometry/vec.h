#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <numbers>

namespace trocar {
inline namespace geometry {

using Vec3 = Eigen::Vector3d;   ///< Point (mm), direction, force (N) or torque (N mm); the name states frame and kind.
using Vec3f = Eigen::Vector3f;  ///< The same in bulk data (meshes).
using Mat3 = Eigen::Matrix3d;

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double radians(double angle_deg) noexcept {
  return angle_deg * std::numbers::pi / 180.0;
}
constexpr double degrees(double angle_rad) noexcept {
  return angle_rad * 180.0 / std::numbers::pi;
}

/// N zero vectors. `std::array<Vec3, N> x{}` is not zero: Eigen does not initialise its components.
template <std::size_t N>
std::array<Vec3, N> zero_vectors() noexcept {
  std::array<Vec3, N> vectors;
  vectors.fill(Vec3::Zero());
  return vectors;
}

}  // namespace geometry
inline namespace geometry {

/// Scales `v` to the length `most` if it is longer, and returns whether it was longer. A vector that contains NaN is
/// not changed. Real-time safe.
inline bool clamp_norm(Vec3& v, double most) noexcept {
  const double norm = v.norm();
  if (!(norm > most)) return false;
  v *= most / norm;
  return true;
}

/// `v`, scaled to the length `most` if it is longer. Real-time safe.
inline Vec3 clamped_norm(Vec3 v, double most) noexcept {
  clamp_norm(v, most);
  return v;
}

}  // namespace geometry
inline namespace geometry {

/// Force (N) and torque (N mm) about a point, in one frame: the name of a variable states the frame, its comment the
/// point.
struct Wrench {
  Vec3 force_n = Vec3::Zero();
  Vec3 torque_nmm = Vec3::Zero();

  Wrench& operator+=(const Wrench& other) noexcept {
    force_n += other.force_n;
    torque_nmm += other.torque_nmm;
    return *this;
  }
  friend Wrench operator+(const Wrench& a, const Wrench& b) noexcept {
    return {a.force_n + b.force_n, a.torque_nmm + b.torque_nmm};
  }
  friend Wrench operator-(const Wrench& a, const Wrench& b) noexcept {
    return {a.force_n - b.force_n, a.torque_nmm - b.torque_nmm};
  }
  friend Wrench operator*(double factor, const Wrench& w) noexcept {
    return {factor * w.force_n, factor * w.torque_nmm};
  }
  /// In another frame: rotated.
  friend Wrench operator*(const Mat3& R, const Wrench& w) noexcept { return {R * w.force_n, R * w.torque_nmm}; }

  /// The same wrench about the point at `to_mm` from its point.
  Wrench shifted_to(const Vec3& to_mm) const noexcept { return {force_n, torque_nmm - to_mm.cross(force_n)}; }
};

}  // namespace geometry
}  // namespace trocar
