#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"

namespace trocar {
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
