#include "geometry/triangle_mesh.h"

namespace trocar {
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
