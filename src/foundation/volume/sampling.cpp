#include "volume/sampling.h"

#include <algorithm>
#include <cmath>

#include "core/result.h"
#include "volume/detail/column_range.h"
#include "volume/detail/sampling_kernels.h"

namespace trocar::volume {
namespace {

using detail::kChunk;

/// The voxel of the grid that is nearest to an index.
Index3 nearest_voxel(const GridGeometry& geometry, const Vec3& index) {
  Index3 voxel;
  for (std::size_t a = 0; a < 3; ++a) {
    const double last = static_cast<double>(geometry.size[a] - 1);
    voxel[a] = static_cast<std::int64_t>(std::clamp(std::round(index[static_cast<int>(a)]), 0.0, last));
  }
  return voxel;
}

/// The grid with positions counted from `anchor`.
detail::CellGrid cells_around(const CtGrid& grid, const Index3& anchor) {
  const auto& size = grid.geometry.size;
  detail::CellGrid cells{};
  cells.voxels = grid.voxels.data() + grid.geometry.offset(anchor);
  for (std::size_t a = 0; a < 3; ++a) {
    const auto low = static_cast<float>(-anchor[a]);
    const auto high = static_cast<float>(size[a] - 1 - anchor[a]);
    cells.axes[a] = {low, std::max(low, high - 1.0F), high};
  }
  cells.stride_j = size[1] > 1 ? static_cast<std::int32_t>(size[0]) : 0;
  cells.stride_k = size[2] > 1 ? static_cast<std::int32_t>(size[0] * size[1]) : 0;
  return cells;
}

/// Interpolates into `out`; a partial vector uses a buffer.
void write_values(const detail::Cells& cells, float outside, std::span<float> out) {
  if (out.size() == kChunk) {
    detail::interpolate(cells, kChunk, outside, out.data());
    return;
  }
  float values[kChunk];
  detail::interpolate(cells, out.size(), outside, values);
  std::copy_n(values, out.size(), out.data());
}

/// Samples a row inside the grid.
void sample_row(const CtGrid& grid, const Vec3& start, const Vec3& step, float outside, std::span<float> out,
                detail::Cells& cells) {
  for (std::size_t first = 0; first < out.size(); first += kChunk) {
    const std::size_t count = std::min(kChunk, out.size() - first);
    const Vec3 chunk_start = start + static_cast<double>(first) * step;
    const Index3 anchor = nearest_voxel(grid.geometry, chunk_start + 0.5 * static_cast<double>(count) * step);
    const detail::CellGrid around = cells_around(grid, anchor);
    detail::RowWalk walk;
    for (int a = 0; a < 3; ++a) {
      walk.start[a] = static_cast<float>(chunk_start[a] - static_cast<double>(anchor[static_cast<std::size_t>(a)]));
      walk.step[a] = static_cast<float>(step[a]);
    }
    detail::locate_row(around, walk, count, cells);
    detail::load_pairs(around, count, cells);
    write_values(cells, outside, out.subspan(first, count));
  }
}

/// The kernels read pairs of voxels along i: a grid of width one has none.
bool has_pairs(const CtGrid& grid) {
  return grid.geometry.size[0] > 1 && !grid.empty();
}

float sample_or(const CtGrid& grid, const Vec3& index, float outside) {
  if (grid.empty() || !detail::is_inside(grid.geometry, index)) return outside;
  return static_cast<float>(sample_linear_at_index(grid, index));
}

/// Iterates over a row of voxel numbers in fixed point, 32 fractional bits: exact to 1e-6 of a voxel after 4096 steps.
class VoxelWalk {
 public:
  VoxelWalk(double start, double step, std::int64_t size) noexcept
      : position_(std::llround((start + 0.5) * kOne)), step_(std::llround(step * kOne)), last_(size - 1) {}
  std::int64_t next() noexcept {
    const std::int64_t voxel = std::clamp<std::int64_t>(position_ >> 32, 0, last_);
    position_ += step_;
    return voxel;
  }

 private:
  static constexpr double kOne = 4294967296.0;
  std::int64_t position_, step_, last_;
};

}  // namespace

void sample_slice_nearest(const Grid<std::uint8_t>& grid, const SlicePlane& plane, std::uint8_t outside,
                          std::span<std::uint8_t> out) {
  const auto columns = static_cast<std::size_t>(plane.columns);
  TROCAR_CHECK(plane.columns >= 0 && plane.rows >= 0 && out.size() == columns * static_cast<std::size_t>(plane.rows));
  const GridGeometry& geometry = grid.geometry;
  const Vec3 step = (geometry.R_PV.transpose() * plane.step_u_P).cwiseQuotient(geometry.spacing_mm);
  const std::int64_t stride_j = geometry.size[0];
  const std::int64_t stride_k = stride_j * geometry.size[1];
  for (int v = 0; v < plane.rows; ++v) {
    std::uint8_t* row = out.data() + static_cast<std::size_t>(v) * columns;
    const Vec3 start = geometry.to_index(plane.origin_P + static_cast<double>(v) * plane.step_v_P);
    const auto range =
        grid.empty() ? detail::ColumnRange{} : detail::columns_inside(geometry, start, step, plane.columns);
    std::fill(row, row + range.first, outside);
    std::fill(row + range.last, row + columns, outside);
    if (range.first == range.last) continue;
    const Vec3 first = start + static_cast<double>(range.first) * step;
    VoxelWalk i(first[0], step[0], geometry.size[0]);
    VoxelWalk j(first[1], step[1], geometry.size[1]);
    VoxelWalk k(first[2], step[2], geometry.size[2]);
    for (int u = range.first; u < range.last; ++u)
      row[u] = grid.voxels[static_cast<std::size_t>(i.next() + j.next() * stride_j + k.next() * stride_k)];
  }
}

void sample_slice(const CtGrid& grid, const SlicePlane& plane, float outside, std::span<float> out) {
  const auto columns = static_cast<std::size_t>(plane.columns);
  TROCAR_CHECK(plane.columns >= 0 && plane.rows >= 0 && out.size() == columns * static_cast<std::size_t>(plane.rows));
  const GridGeometry& geometry = grid.geometry;
  const Vec3 step = (geometry.R_PV.transpose() * plane.step_u_P).cwiseQuotient(geometry.spacing_mm);
  detail::Cells cells;
  for (int v = 0; v < plane.rows; ++v) {
    const std::span<float> row = out.subspan(static_cast<std::size_t>(v) * columns, columns);
    const Vec3 start = geometry.to_index(plane.origin_P + static_cast<double>(v) * plane.step_v_P);
    const auto range =
        grid.empty() ? detail::ColumnRange{} : detail::columns_inside(geometry, start, step, plane.columns);
    const auto first = static_cast<std::size_t>(range.first);
    const auto last = static_cast<std::size_t>(range.last);
    std::fill(row.begin(), row.begin() + range.first, outside);
    std::fill(row.begin() + range.last, row.end(), outside);
    if (has_pairs(grid)) {
      sample_row(grid, start + static_cast<double>(range.first) * step, step, outside, row.subspan(first, last - first),
                 cells);
    } else {
      for (std::size_t u = first; u < last; ++u)
        row[u] = sample_or(grid, start + static_cast<double>(u) * step, outside);
    }
  }
}

void sample_points(const CtGrid& grid, std::span<const Vec3f> points_P, float outside, std::span<float> out) {
  TROCAR_CHECK(out.size() == points_P.size());
  const GridGeometry& geometry = grid.geometry;
  if (!has_pairs(grid)) {
    for (std::size_t n = 0; n < points_P.size(); ++n)
      out[n] = sample_or(grid, geometry.to_index(points_P[n].cast<double>()), outside);
    return;
  }

  // Relative to the centre of the grid, floats are small and precise.
  const Index3 anchor{geometry.size[0] / 2, geometry.size[1] / 2, geometry.size[2] / 2};
  const detail::CellGrid around = cells_around(grid, anchor);
  const Vec3 anchor_P = geometry.centre_mm(anchor);
  const Vec3 near_P = anchor_P.cast<float>().cast<double>();
  const Vec3 offset = geometry.to_index(near_P) - geometry.to_index(anchor_P);
  detail::PointMap map;
  for (int a = 0; a < 3; ++a) {
    map.near_P[a] = static_cast<float>(near_P[a]);
    map.offset[a] = static_cast<float>(offset[a]);
    for (int b = 0; b < 3; ++b) map.matrix[a][b] = static_cast<float>(geometry.R_PV(b, a) / geometry.spacing_mm[a]);
  }

  detail::Cells cells;
  Vec3f last_points[kChunk];
  for (std::size_t first = 0; first < points_P.size(); first += kChunk) {
    const std::size_t count = std::min(kChunk, points_P.size() - first);
    const Vec3f* points = points_P.data() + first;
    if (count < kChunk) {
      std::fill(std::copy_n(points, count, last_points), last_points + kChunk, points[0]);
      points = last_points;
    }
    detail::locate_points(around, map, points, cells);
    detail::load_pairs(around, count, cells);
    write_values(cells, outside, out.subspan(first, count));
  }
}

}  // namespace trocar::volume
