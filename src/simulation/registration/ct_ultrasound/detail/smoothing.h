#pragma once

#include <algorithm>
#include <cstdint>

#include "core/parallel.h"
#include "volume/grid.h"

namespace trocar::registration::detail {

/// Gaussian filter of the standard deviation sigma_mm, edge values continued. Parallel.
void smooth(volume::FloatGrid& grid, double sigma_mm);

/// Means of blocks of `factors` voxels within the box first..first+size; an incomplete block at the end is left out.
template <class T>
volume::FloatGrid block_means(const volume::Grid<T>& grid, const volume::Index3& first, const volume::Index3& size,
                              const volume::Index3& factors) {
  volume::GridGeometry geometry = grid.geometry;
  Vec3 middle;  // of the first block, as an index of the grid
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    geometry.size[a] = std::max<std::int64_t>(1, size[a] / factors[a]);
    geometry.spacing_mm[axis] = grid.geometry.spacing_mm[axis] * static_cast<double>(factors[a]);
    middle[axis] = static_cast<double>(first[a]) + 0.5 * static_cast<double>(factors[a] - 1);
  }
  geometry.origin_P = grid.geometry.to_mm(middle);
  volume::FloatGrid means(geometry);
  if (factors == volume::Index3{1, 1, 1} && size == grid.geometry.size) {
    std::copy(grid.voxels.begin(), grid.voxels.end(), means.voxels.begin());
    return means;
  }
  const float weight = 1.0F / static_cast<float>(factors[0] * factors[1] * factors[2]);
  parallel_for(static_cast<std::size_t>(geometry.size[2]), 1, [&](std::size_t begin, std::size_t end) {
    for (auto k = static_cast<std::int64_t>(begin); k < static_cast<std::int64_t>(end); ++k)
      for (std::int64_t j = 0; j < geometry.size[1]; ++j)
        for (std::int64_t i = 0; i < geometry.size[0]; ++i) {
          float sum = 0.0F;
          for (std::int64_t c = 0; c < factors[2]; ++c)
            for (std::int64_t b = 0; b < factors[1]; ++b)
              for (std::int64_t a = 0; a < factors[0]; ++a)
                sum += static_cast<float>(grid[{std::min(first[0] + i * factors[0] + a, grid.geometry.size[0] - 1),
                                                std::min(first[1] + j * factors[1] + b, grid.geometry.size[1] - 1),
                                                std::min(first[2] + k * factors[2] + c, grid.geometry.size[2] - 1)}]);
          means[{i, j, k}] = sum * weight;
        }
  });
  return means;
}

}  // namespace trocar::registration::detail
