#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "volume/grid.h"

namespace trocar::volume {

/// Value of the voxel nearest to a point of P; `outside` beyond the grid. Real-time safe.
template <class T>
T sample_nearest(const Grid<T>& grid, const Vec3& p_P, T outside) noexcept {
  const Vec3 index = grid.geometry.to_index(p_P);
  if (!((index.array() > -0.5).all() && index.x() < static_cast<double>(grid.geometry.size[0]) - 0.5 &&
        index.y() < static_cast<double>(grid.geometry.size[1]) - 0.5 &&
        index.z() < static_cast<double>(grid.geometry.size[2]) - 0.5))
    return outside;  // also NaN
  const auto round = [](double v) { return static_cast<std::int64_t>(std::floor(v + 0.5)); };
  return grid[{round(index.x()), round(index.y()), round(index.z())}];
}

/// The two of `count` samples in a row beside the place `at` (in samples, kept within the row), and the share of the
/// upper one, 0..1. Real-time safe.
struct Neighbours {
  std::int64_t low = 0, high = 0;
  double share = 0.0;
};
inline Neighbours neighbours(double at, std::int64_t count) noexcept {
  const double held = std::clamp(at, 0.0, static_cast<double>(count - 1));
  const auto low = static_cast<std::int64_t>(held);
  return {low, std::min(low + 1, count - 1), held - static_cast<double>(low)};
}

/// Trilinear value at a fractional index; indices are clamped to the grid (edge values continue). Real-time safe.
template <class T>
double sample_linear_at_index(const Grid<T>& grid, const Vec3& index) noexcept {
  std::int64_t low[3];
  std::int64_t high[3];
  double f[3];
  for (int a = 0; a < 3; ++a) {
    const auto last = static_cast<double>(grid.geometry.size[static_cast<std::size_t>(a)] - 1);
    const double v = index[a] > 0.0 ? std::min(index[a], last) : 0.0;  // NaN becomes 0
    low[a] = static_cast<std::int64_t>(v);
    high[a] = std::min(low[a] + 1, static_cast<std::int64_t>(last));
    f[a] = v - static_cast<double>(low[a]);
  }
  const auto at = [&](std::int64_t i, std::int64_t j, std::int64_t k) { return static_cast<double>(grid[{i, j, k}]); };
  const auto row = [&](std::int64_t j, std::int64_t k) {
    return at(low[0], j, k) * (1 - f[0]) + at(high[0], j, k) * f[0];
  };
  const auto plane = [&](std::int64_t k) { return row(low[1], k) * (1 - f[1]) + row(high[1], k) * f[1]; };
  return plane(low[2]) * (1 - f[2]) + plane(high[2]) * f[2];
}

/// Trilinear value at a point of P; edge values continue outside. Real-time safe.
template <class T>
double sample_linear(const Grid<T>& grid, const Vec3& p_P) noexcept {
  return sample_linear_at_index(grid, grid.geometry.to_index(p_P));
}

/// Gradient per mm in P of the trilinear field, at a point of P, by central differences of half a voxel to each side.
/// Real-time safe.
template <class T>
Vec3 gradient_per_mm(const Grid<T>& grid, const Vec3& p_P) noexcept {
  const Vec3 index = grid.geometry.to_index(p_P);
  Vec3 slope_V;
  for (int a = 0; a < 3; ++a) {
    Vec3 half = Vec3::Zero();
    half[a] = 0.5;
    slope_V[a] = (sample_linear_at_index(grid, index + half) - sample_linear_at_index(grid, index - half)) /
                 grid.geometry.spacing_mm[a];
  }
  return grid.geometry.R_PV * slope_V;
}

/// Sample points in rows and columns on a plane in P: (column u, row v) lies at origin_P + u*step_u_P + v*step_v_P.
struct SlicePlane {
  Vec3 origin_P{0, 0, 0};
  Vec3 step_u_P{1, 0, 0};  ///< mm per column.
  Vec3 step_v_P{0, 1, 0};  ///< mm per row.
  int columns = 512;
  int rows = 512;
};

/// Trilinear samples on a plane, written row by row into `out` (columns*rows, checked). The grid's box reaches half a
/// voxel beyond the outermost voxel centres: in that rim the edge values continue, as in sample_linear; beyond it, and
/// if the plane is not finite, the value is `outside`. The box is the one of sample_nearest. One thread, floats:
/// positions are accurate to 1e-5 of a voxel. SIMD, selected at run time for the processor. No allocation.
void sample_slice(const CtGrid& grid, const SlicePlane& plane, float outside, std::span<float> out);
/// The value of the nearest voxel at each point of a plane, `outside` beyond the grid's box, as in sample_nearest
/// (positions on the border of two voxels may fall to either side). One thread, no allocation.
void sample_slice_nearest(const Grid<std::uint8_t>& grid, const SlicePlane& plane, std::uint8_t outside,
                          std::span<std::uint8_t> out);
/// As sample_slice, at arbitrary points of P; `out` has the length of `points_P` (checked). Points within 1e-4 of a
/// voxel of the box's faces may fall to either side.
void sample_points(const CtGrid& grid, std::span<const Vec3f> points_P, float outside, std::span<float> out);

}  // namespace trocar::volume
