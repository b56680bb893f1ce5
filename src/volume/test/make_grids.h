#pragma once

#include "core/random.h"
#include "geometry/pose.h"
#include "volume/grid.h"

namespace trocar {

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

/// A turned, shifted grid of unequal spacing.
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

/// Every voxel different from its neighbours, over the whole range of CT values.
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

}  // namespace trocar
