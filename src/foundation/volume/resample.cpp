#include "volume/resample.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/result.h"
#include "volume/detail/column_range.h"
#include "volume/detail/weighted_rows.h"
#include "volume/sampling.h"

namespace trocar::volume {
namespace {

/// Straight row of voxel centres of a target grid, as fractional indices of the source.
struct Row {
  Vec3 start;
  Vec3 step;
};

Row target_row(const GridGeometry& source, const GridGeometry& target, std::int64_t j, std::int64_t k) {
  const Vec3 first(0.0, static_cast<double>(j), static_cast<double>(k));
  const Vec3 start = source.to_index(target.to_mm(first));
  const Vec3 step =
      (source.R_PV.transpose() * target.R_PV.col(0) * target.spacing_mm.x()).cwiseQuotient(source.spacing_mm);
  return {start, step};
}

/// A k plane of the target as a slice plane.
SlicePlane target_plane(const GridGeometry& target, std::int64_t k) {
  SlicePlane plane;
  plane.origin_P = target.to_mm({0.0, 0.0, static_cast<double>(k)});
  plane.step_u_P = target.R_PV.col(0) * target.spacing_mm.x();
  plane.step_v_P = target.R_PV.col(1) * target.spacing_mm.y();
  plane.columns = static_cast<int>(target.size[0]);
  plane.rows = static_cast<int>(target.size[1]);
  return plane;
}

}  // namespace

CtGrid resample_linear(const CtGrid& source, const GridGeometry& target, std::int16_t outside) {
  CtGrid result(target, outside);
  const auto plane_size = static_cast<std::size_t>(target.size[0] * target.size[1]);
  parallel_for(static_cast<std::size_t>(target.size[2]), 1, [&](std::size_t first, std::size_t last) {
    std::vector<float> values(plane_size);
    for (std::size_t k = first; k < last; ++k) {
      sample_slice(source, target_plane(target, static_cast<std::int64_t>(k)), outside, values);
      std::transform(values.begin(), values.end(), result.voxels.begin() + static_cast<std::ptrdiff_t>(k * plane_size),
                     [](float v) { return static_cast<std::int16_t>(std::floor(v + 0.5F)); });
    }
  });
  return result;
}

LabelGrid resample_nearest(const LabelGrid& source, const GridGeometry& target, std::uint8_t outside) {
  LabelGrid result(target, outside);
  const auto columns = static_cast<int>(target.size[0]);
  const auto rows = static_cast<std::size_t>(target.size[1] * target.size[2]);
  // Half-way places go up, and so do those that a file's rounding has put just below.
  constexpr double kRounding = 1e-4;
  const auto round = [&](double v, std::size_t axis) {
    return std::min(static_cast<std::int64_t>(std::floor(v + 0.5 + kRounding)), source.geometry.size[axis] - 1);
  };
  parallel_for(rows, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t r = first; r < last; ++r) {
      const auto n = static_cast<std::int64_t>(r);
      const Row row = target_row(source.geometry, target, n % target.size[1], n / target.size[1]);
      const auto range = detail::columns_inside(source.geometry, row.start, row.step, columns);
      std::uint8_t* out = result.voxels.data() + r * static_cast<std::size_t>(columns);
      for (int u = range.first; u < range.last; ++u) {
        const Vec3 index = row.start + static_cast<double>(u) * row.step;
        out[u] = source[{round(index.x(), 0), round(index.y(), 1), round(index.z(), 2)}];
      }
    }
  });
  return result;
}

GridGeometry isotropic_geometry(const GridGeometry& source, double spacing_mm) {
  TROCAR_CHECK(spacing_mm > 0.0);
  GridGeometry result = source;
  Vec3 first_centre;  // of the new grid, as an index of the old one
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const double extent_mm = static_cast<double>(source.size[axis]) * source.spacing_mm[a];
    result.size[axis] = std::max<std::int64_t>(1, std::llround(extent_mm / spacing_mm));
    result.spacing_mm[a] = extent_mm / static_cast<double>(result.size[axis]);
    first_centre[a] = 0.5 * result.spacing_mm[a] / source.spacing_mm[a] - 0.5;
  }
  result.origin_P = source.to_mm(first_centre);
  return result;
}

double overlap_fraction(const GridGeometry& source, const GridGeometry& target) {
  if (target.voxel_count() == 0) return 0.0;
  std::int64_t inside = 0;
  for (std::int64_t k = 0; k < target.size[2]; ++k) {
    for (std::int64_t j = 0; j < target.size[1]; ++j) {
      const Row row = target_row(source, target, j, k);
      const auto range = detail::columns_inside(source, row.start, row.step, static_cast<int>(target.size[0]));
      inside += range.last - range.first;
    }
  }
  return static_cast<double>(inside) / static_cast<double>(target.voxel_count());
}

namespace {

double nearness(const Mat3& R_PV, const std::array<std::size_t, 3>& axis) noexcept {
  double sum = 0.0;
  for (int n = 0; n < 3; ++n) sum += std::abs(R_PV(n, static_cast<Eigen::Index>(axis[static_cast<std::size_t>(n)])));
  return sum;
}

template <class T>
Grid<T> along_P_of(Grid<T> grid) {
  const AxisOrder order = order_along_P(grid.geometry);
  if (order.is_identity()) return grid;
  Grid<T> result(reordered(grid.geometry, order));
  const std::array<std::int64_t, 3> stride{1, grid.geometry.size[0], grid.geometry.size[0] * grid.geometry.size[1]};
  std::array<std::int64_t, 3> step{};
  std::int64_t first = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    step[n] = order.is_turned[n] ? -stride[order.axis[n]] : stride[order.axis[n]];
    if (order.is_turned[n]) first += stride[order.axis[n]] * (grid.geometry.size[order.axis[n]] - 1);
  }
  const Index3& size = result.geometry.size;
  parallel_for(static_cast<std::size_t>(size[2]), 1, [&](std::size_t begin, std::size_t end) {
    for (auto k = static_cast<std::int64_t>(begin); k < static_cast<std::int64_t>(end); ++k)
      for (std::int64_t j = 0; j < size[1]; ++j) {
        T* to = result.voxels.data() + result.geometry.offset({0, j, k});
        const std::int64_t from = first + k * step[2] + j * step[1];
        for (std::int64_t i = 0; i < size[0]; ++i) to[i] = grid.voxels[static_cast<std::size_t>(from + i * step[0])];
      }
  });
  return result;
}

}  // namespace

AxisOrder order_along_P(const GridGeometry& geometry) noexcept {
  constexpr double kTie = 1e-9;
  AxisOrder order;
  std::array<std::size_t, 3> axis{0, 1, 2};
  double best = -1.0;
  do {
    const double sum = nearness(geometry.R_PV, axis);
    if (sum <= best + kTie) continue;
    best = sum;
    order.axis = axis;
  } while (std::next_permutation(axis.begin(), axis.end()));
  for (std::size_t n = 0; n < 3; ++n)
    order.is_turned[n] = geometry.R_PV(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(order.axis[n])) < 0.0;
  return order;
}

GridGeometry reordered(const GridGeometry& geometry, const AxisOrder& order) noexcept {
  GridGeometry result = geometry;
  Vec3 first_index = Vec3::Zero();
  for (std::size_t n = 0; n < 3; ++n) {
    const std::size_t from = order.axis[n];
    const auto to_column = static_cast<Eigen::Index>(n);
    const auto from_column = static_cast<Eigen::Index>(from);
    result.size[n] = geometry.size[from];
    result.spacing_mm[to_column] = geometry.spacing_mm[from_column];
    result.R_PV.col(to_column) = geometry.R_PV.col(from_column);
    if (!order.is_turned[n]) continue;
    result.R_PV.col(to_column) *= -1.0;
    first_index[from_column] = static_cast<double>(geometry.size[from] - 1);
  }
  result.R_PV.array() += 0.0;  // -0 becomes 0
  result.origin_P = geometry.to_mm(first_index);
  return result;
}

CtGrid along_P(CtGrid grid) {
  return along_P_of(std::move(grid));
}

LabelGrid along_P(LabelGrid grid) {
  return along_P_of(std::move(grid));
}

namespace {

constexpr double kCut_sigma = 4.0;

/// Weights at -radius..radius.
std::vector<float> gaussian(double sigma) {
  const int radius = static_cast<int>(std::ceil(kCut_sigma * sigma));
  std::vector<float> weights(static_cast<std::size_t>(2 * radius + 1));
  double sum = 0.0;
  for (int t = -radius; t <= radius; ++t) sum += std::exp(-0.5 * t * t / (sigma * sigma));
  for (int t = -radius; t <= radius; ++t)
    weights[static_cast<std::size_t>(t + radius)] = static_cast<float>(std::exp(-0.5 * t * t / (sigma * sigma)) / sum);
  return weights;
}

/// Row of voxels along i.
std::size_t row_length(const FloatGrid& grid) {
  return static_cast<std::size_t>(grid.geometry.size[0]);
}

void blur_along_i(FloatGrid& grid, const std::vector<float>& weights) {
  const std::size_t length = row_length(grid);
  const std::size_t radius = weights.size() / 2;
  parallel_for(grid.voxels.size() / length, 64, [&](std::size_t first, std::size_t last) {
    std::vector<float> padded(length + 2 * radius, 0.0F);
    std::vector<const float*> sources(weights.size());
    for (std::size_t t = 0; t < sources.size(); ++t) sources[t] = padded.data() + t;
    for (std::size_t row = first; row < last; ++row) {
      float* voxels = grid.voxels.data() + row * length;
      std::copy(voxels, voxels + length, padded.begin() + static_cast<std::ptrdiff_t>(radius));
      detail::add_weighted_rows(sources, weights, {voxels, length});
    }
  });
}

/// Blurs along j or k: `count` rows, `stride` voxels apart, from each of `starts`.
void blur_along_rows(FloatGrid& grid, std::int64_t count, std::size_t stride, std::size_t starts,
                     std::size_t start_stride, const std::vector<float>& weights) {
  const std::size_t length = row_length(grid);
  const auto radius = static_cast<std::int64_t>(weights.size() / 2);
  parallel_for(starts, 1, [&](std::size_t first, std::size_t last) {
    std::vector<float> copy(static_cast<std::size_t>(count) * length);
    std::vector<const float*> sources;
    for (std::size_t start = first; start < last; ++start) {
      float* voxels = grid.voxels.data() + start * start_stride;
      for (std::int64_t n = 0; n < count; ++n) {
        const float* row = voxels + static_cast<std::size_t>(n) * stride;
        std::copy(row, row + length, copy.begin() + n * static_cast<std::int64_t>(length));
      }
      for (std::int64_t n = 0; n < count; ++n) {
        const std::int64_t from = std::max<std::int64_t>(0, n - radius), to = std::min(count - 1, n + radius);
        sources.clear();
        for (std::int64_t s = from; s <= to; ++s) sources.push_back(copy.data() + static_cast<std::size_t>(s) * length);
        const std::span<const float> used(weights.data() + (from - n + radius), sources.size());
        detail::add_weighted_rows(sources, used, {voxels + static_cast<std::size_t>(n) * stride, length});
      }
    }
  });
}

}  // namespace

void gaussian_blur(FloatGrid& grid, const Vec3& sigma_voxels) {
  TROCAR_CHECK((sigma_voxels.array() >= 0.0).all());
  if (grid.empty()) return;
  const auto& size = grid.geometry.size;
  const std::size_t row = row_length(grid);
  const std::size_t plane = row * static_cast<std::size_t>(size[1]);
  if (sigma_voxels[0] > 0.0) blur_along_i(grid, gaussian(sigma_voxels[0]));
  if (sigma_voxels[1] > 0.0)
    blur_along_rows(grid, size[1], row, static_cast<std::size_t>(size[2]), plane, gaussian(sigma_voxels[1]));
  if (sigma_voxels[2] > 0.0)
    blur_along_rows(grid, size[2], plane, static_cast<std::size_t>(size[1]), row, gaussian(sigma_voxels[2]));
}

}  // namespace trocar::volume
