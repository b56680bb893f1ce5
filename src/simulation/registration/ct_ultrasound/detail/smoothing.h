#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/parallel.h"
#include "volume/grid.h"

namespace trocar::registration::detail {

/// Gaussian filter of the standard deviation sigma_mm, edge values continued. Parallel.
void smooth(volume::FloatGrid& grid, double sigma_mm);

/// Adds the sum of the next `factor` values to each sum.
template <class T>
void add_blocks(const T* values, std::int64_t factor, std::span<float> sums) {
  if (factor == 1) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += static_cast<float>(values[i]);
    return;
  }
  for (float& sum : sums)
    for (std::int64_t a = 0; a < factor; ++a) sum += static_cast<float>(*values++);
}

/// Means of blocks of `factors` voxels within the box first..first+size; an incomplete block at the end is left out.
/// Blocks are at most as long as the box, which has voxels and lies in the grid.
template <class T>
volume::FloatGrid block_means(const volume::Grid<T>& grid, const volume::Index3& first, const volume::Index3& size,
                              volume::Index3 factors) {
  volume::GridGeometry geometry = grid.geometry;
  Vec3 middle;  // of the first block, as an index of the grid
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    factors[a] = std::min(factors[a], size[a]);
    geometry.size[a] = size[a] / factors[a];
    geometry.spacing_mm[axis] = grid.geometry.spacing_mm[axis] * static_cast<double>(factors[a]);
    middle[axis] = static_cast<double>(first[a]) + 0.5 * static_cast<double>(factors[a] - 1);
  }
  geometry.origin_P = grid.geometry.to_mm(middle);
  volume::FloatGrid means(geometry);
  const float weight = 1.0F / static_cast<float>(factors[0] * factors[1] * factors[2]);
  parallel_for(static_cast<std::size_t>(geometry.size[2]), 1, [&](std::size_t begin, std::size_t end) {
    for (auto k = static_cast<std::int64_t>(begin); k < static_cast<std::int64_t>(end); ++k)
      for (std::int64_t j = 0; j < geometry.size[1]; ++j) {
        const std::span<float> row(&means[{0, j, k}], static_cast<std::size_t>(geometry.size[0]));
        for (std::int64_t c = 0; c < factors[2]; ++c)
          for (std::int64_t b = 0; b < factors[1]; ++b)
            add_blocks(&grid[{first[0], first[1] + j * factors[1] + b, first[2] + k * factors[2] + c}], factors[0],
                       row);
        for (float& mean : row) mean *= weight;
      }
  });
  return means;
}

}  // namespace trocar::registration::detail
