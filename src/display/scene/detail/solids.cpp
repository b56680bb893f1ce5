#include "scene/detail/solids.h"

#include <cmath>
#include <numbers>

namespace trocar::scene::detail {
namespace {

std::uint32_t add_point(TriangleMesh& mesh, const Vec3& p) {
  mesh.vertices.push_back(p.cast<float>());
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

/// A lid with its own points, so that the edge stays sharp.
void add_lid(TriangleMesh& mesh, const std::vector<Vec3>& ring, bool faces_forward) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : ring) middle += p;
  const std::uint32_t center = add_point(mesh, middle / static_cast<double>(ring.size()));
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3& p : ring) add_point(mesh, p);
  const auto count = static_cast<std::uint32_t>(ring.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = first + i;
    const std::uint32_t b = first + (i + 1) % count;
    mesh.triangles.push_back(faces_forward ? std::array{center, a, b} : std::array{center, b, a});
  }
}

}  // namespace

TriangleMesh make_loft(const std::vector<std::vector<Vec3>>& rings) {
  TriangleMesh mesh;
  const auto sides = static_cast<std::uint32_t>(rings.front().size());
  for (const auto& ring : rings) {
    for (const Vec3& p : ring) add_point(mesh, p);
  }
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      const std::uint32_t next = (s + 1) % sides;
      const std::uint32_t low = r * sides;
      const std::uint32_t high = low + sides;
      mesh.triangles.push_back({low + s, low + next, high + next});
      mesh.triangles.push_back({low + s, high + next, high + s});
    }
  }
  add_lid(mesh, rings.front(), false);
  add_lid(mesh, rings.back(), true);
  return mesh;
}

TriangleMesh make_turned(const Pose& X_AL, std::span<const Ring> rings, int sides) {
  std::vector<std::vector<Vec3>> circles;
  for (const Ring& ring : rings) {
    std::vector<Vec3> circle;
    for (int s = 0; s < sides; ++s) {
      const double angle = 2.0 * std::numbers::pi * s / sides;
      circle.push_back(X_AL * Vec3(ring.r * std::cos(angle), ring.r * std::sin(angle), ring.z));
    }
    circles.push_back(std::move(circle));
  }
  return make_loft(circles);
}

TriangleMesh make_box(const Pose& X_AL, const Vec3& half_mm, double corner_mm) {
  constexpr int kStepsOfCorner = 4;
  std::vector<std::vector<Vec3>> outlines;
  for (const double z : {-half_mm.z(), half_mm.z()}) {
    std::vector<Vec3> outline;
    for (int corner = 0; corner < 4; ++corner) {
      const double sx = corner == 0 || corner == 3 ? 1.0 : -1.0;
      const double sy = corner < 2 ? 1.0 : -1.0;
      for (int step = 0; step <= kStepsOfCorner; ++step) {
        const double angle = 0.5 * std::numbers::pi * (corner + static_cast<double>(step) / kStepsOfCorner);
        outline.push_back(X_AL * Vec3(sx * (half_mm.x() - corner_mm) + corner_mm * std::cos(angle),
                                      sy * (half_mm.y() - corner_mm) + corner_mm * std::sin(angle), z));
      }
    }
    outlines.push_back(std::move(outline));
  }
  return make_loft(outlines);
}

}  // namespace trocar::scene::detail
