#include "volume/orientation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"

namespace trocar::volume {
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

}  // namespace trocar::volume
