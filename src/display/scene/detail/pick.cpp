#include "scene/detail/pick.h"

#include <cmath>

namespace trocar::scene::detail {

std::optional<double> first_hit_mm(const TriangleMesh& mesh, const Vec3& origin, const Vec3& direction) {
  // The intersection in barycentric coordinates (Möller and Trumbore, 1997).
  std::optional<double> nearest_mm;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]].cast<double>();
    const Vec3 edge_b = mesh.vertices[t[1]].cast<double>() - a;
    const Vec3 edge_c = mesh.vertices[t[2]].cast<double>() - a;
    const Vec3 square = direction.cross(edge_c);
    const double area = edge_b.dot(square);
    if (std::abs(area) < 1e-12) continue;
    const Vec3 from_a = origin - a;
    const double u = from_a.dot(square) / area;
    if (u < 0.0 || u > 1.0) continue;
    const Vec3 other = from_a.cross(edge_b);
    const double v = direction.dot(other) / area;
    if (v < 0.0 || u + v > 1.0) continue;
    const double along_mm = edge_c.dot(other) / area;
    if (along_mm > 0.0 && (!nearest_mm || along_mm < *nearest_mm)) nearest_mm = along_mm;
  }
  return nearest_mm;
}

}  // namespace trocar::scene::detail
