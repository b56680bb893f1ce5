#pragma once

#include "geometry/vec.h"

namespace trocar {
inline namespace geometry {

/// A line segment from a to b.
struct Segment {
  Vec3 a;
  Vec3 b;

  double length_mm() const noexcept { return (b - a).norm(); }
  Vec3 direction() const noexcept { return (b - a).normalized(); }
  Vec3 at(double fraction) const noexcept { return a + fraction * (b - a); }
};

/// Fraction in 0..1 of the point of the segment that is closest to q. Real-time safe.
double closest_fraction(const Segment& segment, const Vec3& q) noexcept;
double distance_mm(const Segment& segment, const Vec3& q) noexcept;
/// Distance of q from the infinite line through `origin` along the unit vector `direction`.
double distance_to_line_mm(const Vec3& origin, const Vec3& direction, const Vec3& q) noexcept;

}  // namespace geometry
}  // namespace trocar
