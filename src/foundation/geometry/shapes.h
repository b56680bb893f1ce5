#pragma once

#include <array>
#include <cstdint>
#include <vector>

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
inline namespace geometry {

/// A surface: vertices in mm, triangles counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Volume inside a closed mesh in mm^3 (divergence theorem); positive where triangles face outward.
double enclosed_volume_mm3(const TriangleMesh& mesh) noexcept;
double area_mm2(const TriangleMesh& mesh) noexcept;

}  // namespace geometry
}  // namespace trocar
