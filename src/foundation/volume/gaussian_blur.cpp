#include "volume/gaussian_blur.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/check.h"
#include "core/parallel.h"
#include "volume/detail/weighted_rows.h"

namespace trocar::volume {
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
