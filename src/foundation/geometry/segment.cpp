#include "geometry/segment.h"

#include <algorithm>

namespace trocar {
inline namespace geometry {

double closest_fraction(const Segment& segment, const Vec3& q) noexcept {
  const Vec3 along = segment.b - segment.a;
  const double squared = along.squaredNorm();
  return squared > 0.0 ? std::clamp((q - segment.a).dot(along) / squared, 0.0, 1.0) : 0.0;
}

double distance_mm(const Segment& segment, const Vec3& q) noexcept {
  return (q - segment.at(closest_fraction(segment, q))).norm();
}

double distance_to_line_mm(const Vec3& origin, const Vec3& direction, const Vec3& q) noexcept {
  return direction.cross(q - origin).norm();
}

}  // namespace geometry
}  // namespace trocar
