#include "geometry/shapes.h"

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
inline namespace geometry {

double enclosed_volume_mm3(const TriangleMesh& mesh) noexcept {
  double six_volumes = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 p = mesh.vertices[a].cast<double>();
    six_volumes += p.dot(mesh.vertices[b].cast<double>().cross(mesh.vertices[c].cast<double>()));
  }
  return six_volumes / 6.0;
}

double area_mm2(const TriangleMesh& mesh) noexcept {
  double twice = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 p = mesh.vertices[a].cast<double>();
    twice += (mesh.vertices[b].cast<double>() - p).cross(mesh.vertices[c].cast<double>() - p).norm();
  }
  return twice / 2.0;
}

}  // namespace geometry
}  // namespace trocar
