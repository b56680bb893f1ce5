#pragma once

#include <cmath>

#include "volume/grid.h"

namespace trocar::testing {

/// A grid of about this extent, centred on the origin of P.
inline volume::GridGeometry centred_grid(const Vec3& extent_mm, const Vec3& spacing_mm) {
  volume::GridGeometry geometry;
  geometry.spacing_mm = spacing_mm;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    geometry.size[a] = std::llround(extent_mm[axis] / spacing_mm[axis]);
  }
  geometry.origin_P = -0.5 * (volume::to_vec3(geometry.size) - Vec3::Ones()).cwiseProduct(spacing_mm);
  return geometry;
}

}  // namespace trocar::testing
