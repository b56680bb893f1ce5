#include "registration/ct_ultrasound/detail/smoothing.h"

#include <array>
#include <cmath>
#include <vector>

namespace trocar::registration::detail {
namespace {

constexpr double kReach = 3.0;         ///< Standard deviations within the kernel.
constexpr double kNarrowest = 0.2;     ///< Voxels; a narrower kernel changes nothing.
constexpr std::int64_t kColumns = 32;  ///< Lines along j or k are filtered side by side, for the processor's cache.

std::vector<float> kernel_of(double sigma_voxels) {
  const int reach = static_cast<int>(std::ceil(kReach * sigma_voxels));
  std::vector<float> kernel(static_cast<std::size_t>(2 * reach + 1));
  float sum = 0.0F;
  for (int n = -reach; n <= reach; ++n) {
    const double x = static_cast<double>(n) / sigma_voxels;
    sum += kernel[static_cast<std::size_t>(n + reach)] = static_cast<float>(std::exp(-0.5 * x * x));
  }
  for (float& weight : kernel) weight /= sum;
  return kernel;
}

/// Weighted sums of values `stride` apart, for each of the `count` values from `in`. Values at equal distances have
/// equal weights.
void add_taps(const float* in, std::int64_t stride, std::int64_t count, const std::vector<float>& kernel, float* out) {
  const auto reach = static_cast<std::int64_t>(kernel.size() / 2);
  const float* weights = kernel.data() + reach;
  for (std::int64_t n = 0; n < count; ++n) out[n] = weights[0] * in[n];
  for (std::int64_t t = 1; t <= reach; ++t) {
    const float *before = in - t * stride, *after = in + t * stride;
    for (std::int64_t n = 0; n < count; ++n) out[n] += weights[t] * (before[n] + after[n]);
  }
}

/// `columns` neighbouring lines of `count` samples, `stride` apart.
void filter_lines(float* first, std::int64_t columns, std::int64_t count, std::int64_t stride,
                  const std::vector<float>& kernel, std::vector<float>& copy) {
  const auto reach = static_cast<std::int64_t>(kernel.size() / 2);
  copy.resize(static_cast<std::size_t>((count + 2 * reach) * columns));
  for (std::int64_t n = -reach; n < count + reach; ++n) {
    const float* line = first + std::clamp<std::int64_t>(n, 0, count - 1) * stride;
    std::copy(line, line + columns, copy.begin() + (n + reach) * columns);
  }
  for (std::int64_t n = 0; n < count; ++n) {
    add_taps(copy.data() + (n + reach) * columns, columns, columns, kernel, first + n * stride);
  }
}

void filter_rows(volume::FloatGrid& grid, const std::vector<float>& kernel) {
  const std::int64_t count = grid.geometry.size[0];
  const auto reach = static_cast<std::int64_t>(kernel.size() / 2);
  const auto rows = static_cast<std::size_t>(grid.geometry.size[1] * grid.geometry.size[2]);
  parallel_for(rows, 64, [&](std::size_t first, std::size_t last) {
    std::vector<float> copy(static_cast<std::size_t>(count + 2 * reach));
    for (std::size_t r = first; r < last; ++r) {
      float* row = grid.voxels.data() + static_cast<std::ptrdiff_t>(r) * count;
      for (std::int64_t n = -reach; n < count + reach; ++n)
        copy[static_cast<std::size_t>(n + reach)] = row[std::clamp<std::int64_t>(n, 0, count - 1)];
      add_taps(copy.data() + reach, 1, count, kernel, row);
    }
  });
}

void filter_across(volume::FloatGrid& grid, std::size_t axis, const std::vector<float>& kernel) {
  const auto& size = grid.geometry.size;
  const std::int64_t stride = axis == 1 ? size[0] : size[0] * size[1];
  const std::int64_t parts = (size[0] + kColumns - 1) / kColumns;
  const std::int64_t others = axis == 1 ? size[2] : size[1];
  const std::int64_t other_stride = axis == 1 ? size[0] * size[1] : size[0];
  parallel_for(static_cast<std::size_t>(parts * others), 4, [&](std::size_t first, std::size_t last) {
    std::vector<float> copy;
    for (auto n = static_cast<std::int64_t>(first); n < static_cast<std::int64_t>(last); ++n) {
      const std::int64_t column = (n % parts) * kColumns;
      filter_lines(grid.voxels.data() + (n / parts) * other_stride + column, std::min(kColumns, size[0] - column),
                   size[axis], stride, kernel, copy);
    }
  });
}

}  // namespace

void smooth(volume::FloatGrid& grid, double sigma_mm) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double sigma = sigma_mm / grid.geometry.spacing_mm[static_cast<int>(axis)];
    if (sigma < kNarrowest || grid.geometry.size[axis] < 2) continue;
    const std::vector<float> kernel = kernel_of(sigma);
    if (axis == 0)
      filter_rows(grid, kernel);
    else
      filter_across(grid, axis, kernel);
  }
}

}  // namespace trocar::registration::detail
