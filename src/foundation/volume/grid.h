#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/result.h"
#include "geometry/vec.h"

namespace trocar::volume {

using Index3 = std::array<std::int64_t, 3>;  ///< Voxel index (i, j, k).

inline Vec3 to_vec3(const Index3& ijk) noexcept {
  return {static_cast<double>(ijk[0]), static_cast<double>(ijk[1]), static_cast<double>(ijk[2])};
}

/// Position of a voxel grid in the patient frame P (LPS, mm), as in ITK: voxel centres at integer indices.
/// Invariant kept by the readers: spacing > 0, direction orthonormal (a mirrored grid is re-ordered while it is read).
struct GridGeometry {
  std::array<std::int64_t, 3> size{0, 0, 0};  ///< Voxels along i, j, k.
  Vec3 spacing_mm{1.0, 1.0, 1.0};
  Vec3 origin_P{0.0, 0.0, 0.0};  ///< Centre of voxel (0,0,0).
  Mat3 R_PV = Mat3::Identity();  ///< Columns: directions of i, j, k in P.

  std::size_t voxel_count() const noexcept { return static_cast<std::size_t>(size[0] * size[1] * size[2]); }
  double voxel_volume_mm3() const noexcept { return spacing_mm.prod(); }
  /// Index (may be fractional) -> point in P.
  Vec3 to_mm(const Vec3& index) const noexcept { return origin_P + R_PV * index.cwiseProduct(spacing_mm); }
  /// Centre of a voxel in P.
  Vec3 centre_mm(const Index3& ijk) const noexcept { return to_mm(to_vec3(ijk)); }
  /// Point in P -> fractional index.
  Vec3 to_index(const Vec3& p_P) const noexcept {
    return (R_PV.transpose() * (p_P - origin_P)).cwiseQuotient(spacing_mm);
  }
  bool contains(const Index3& ijk) const noexcept {
    return ijk[0] >= 0 && ijk[1] >= 0 && ijk[2] >= 0 && ijk[0] < size[0] && ijk[1] < size[1] && ijk[2] < size[2];
  }
  std::size_t offset(const Index3& ijk) const noexcept {
    return static_cast<std::size_t>((ijk[2] * size[1] + ijk[1]) * size[0] + ijk[0]);
  }
  Index3 index_of(std::size_t offset) const noexcept {
    const auto n = static_cast<std::int64_t>(offset);
    return {n % size[0], (n / size[0]) % size[1], n / (size[0] * size[1])};
  }
  /// Same size and, within a hundredth of a voxel, same place.
  bool matches(const GridGeometry& other) const noexcept;
};

/// A volume: one value per voxel, i running fastest.
template <class T>
struct Grid {
  GridGeometry geometry;
  std::vector<T> voxels;

  Grid() = default;
  explicit Grid(const GridGeometry& g, T value = T{}) : geometry(g), voxels(g.voxel_count(), value) {}

  T& operator[](const Index3& ijk) noexcept { return voxels[geometry.offset(ijk)]; }
  const T& operator[](const Index3& ijk) const noexcept { return voxels[geometry.offset(ijk)]; }
  bool empty() const noexcept { return voxels.empty(); }
};

using CtGrid = Grid<std::int16_t>;     ///< Hounsfield units.
using LabelGrid = Grid<std::uint8_t>;  ///< Label ids, 0 = nothing labelled.
using MaskGrid = Grid<std::uint8_t>;   ///< 0 or 1.
using FloatGrid = Grid<float>;

}  // namespace trocar::volume
