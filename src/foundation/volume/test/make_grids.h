#pragma once

#include <algorithm>
#include <array>

#include "core/random.h"
#include "geometry/pose.h"
#include "volume/grid.h"

namespace trocar::volume {

inline Vec3 random_vec(Random& random, double low, double high) {
  const double x = random.uniform(low, high);
  const double y = random.uniform(low, high);
  return {x, y, random.uniform(low, high)};
}

inline Vec3 random_direction(Random& random) {
  return Vec3(random.normal(), random.normal(), random.normal()).normalized();
}

inline Mat3 random_rotation(Random& random) {
  return Eigen::AngleAxisd(random.uniform(0.0, 3.14), random_direction(random)).toRotationMatrix();
}

/// A rotated, shifted grid of unequal spacing.
inline GridGeometry oblique_geometry(const Index3& size, Random& random) {
  GridGeometry geometry;
  geometry.size = size;
  geometry.spacing_mm = random_vec(random, 0.4, 2.5);
  geometry.origin_P = random_vec(random, -300.0, 300.0);
  geometry.R_PV = random_rotation(random);
  return geometry;
}

inline GridGeometry plain_geometry(const Index3& size, const Vec3& spacing_mm = Vec3::Ones()) {
  GridGeometry geometry;
  geometry.size = size;
  geometry.spacing_mm = spacing_mm;
  return geometry;
}

/// The same voxels at the same places, stored in another order: axis n of the result is `axis[n]` of the source,
/// traversed from its far end if `is_turned[n]`.
template <class T>
Grid<T> stored_in_order(const Grid<T>& grid, const std::array<std::size_t, 3>& axis,
                        const std::array<bool, 3>& is_turned) {
  GridGeometry geometry = grid.geometry;
  Vec3 corner = Vec3::Zero();
  for (std::size_t n = 0; n < 3; ++n) {
    const auto to = static_cast<Eigen::Index>(n);
    const auto from = static_cast<Eigen::Index>(axis[n]);
    geometry.size[n] = grid.geometry.size[axis[n]];
    geometry.spacing_mm[to] = grid.geometry.spacing_mm[from];
    geometry.R_PV.col(to) = (is_turned[n] ? -1.0 : 1.0) * grid.geometry.R_PV.col(from);
    if (is_turned[n]) corner[from] = static_cast<double>(grid.geometry.size[axis[n]] - 1);
  }
  geometry.origin_P = grid.geometry.to_mm(corner);
  Grid<T> result(geometry);
  for (std::size_t n = 0; n < result.voxels.size(); ++n) {
    const Index3 to = geometry.index_of(n);
    Index3 from{};
    for (std::size_t a = 0; a < 3; ++a) from[axis[a]] = is_turned[a] ? geometry.size[a] - 1 - to[a] : to[a];
    result.voxels[n] = grid[from];
  }
  return result;
}

/// Calls visit(axis, is_turned) for the 48 orders in which a volume can be stored.
void for_each_storage_order(const auto& visit) {
  std::array<std::size_t, 3> axis{0, 1, 2};
  do {
    for (int turns = 0; turns < 8; ++turns)
      visit(axis, std::array<bool, 3>{(turns & 1) != 0, (turns & 2) != 0, (turns & 4) != 0});
  } while (std::next_permutation(axis.begin(), axis.end()));
}

/// Noise: every voxel differs from its neighbours, over the whole range of CT values.
inline CtGrid noise_ct(const GridGeometry& geometry, Random& random) {
  CtGrid ct(geometry);
  for (auto& voxel : ct.voxels) voxel = static_cast<std::int16_t>(static_cast<int>(random.next() % 4096) - 1024);
  return ct;
}

inline MaskGrid noise_mask(const GridGeometry& geometry, double filled, Random& random) {
  MaskGrid mask(geometry);
  for (auto& voxel : mask.voxels) voxel = random.uniform() < filled ? 1 : 0;
  return mask;
}

}  // namespace trocar::volume
