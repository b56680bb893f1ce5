#pragma once

#include "geometry/vec.h"

namespace trocar {
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
