#include "volume/grid.h"

namespace trocar::volume {

bool GridGeometry::matches(const GridGeometry& other) const noexcept {
  constexpr double kToleranceVoxels = 0.01;
  if (size != other.size) return false;

  // Both maps are affine: if the eight corners agree, everything between them does.
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int a = 0; a < 3; ++a)
      index[a] = ((corner >> a) & 1) != 0 ? static_cast<double>(size[static_cast<std::size_t>(a)] - 1) : 0.0;
    const Vec3 difference = other.to_index(to_mm(index)) - index;
    if (!(difference.cwiseAbs().maxCoeff() <= kToleranceVoxels)) return false;  // also NaN
  }
  return true;
}

}  // namespace trocar::volume
