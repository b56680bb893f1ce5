#include "registration/intensity/gray_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "core/result.h"
#include "volume/resample.h"
#include "volume/sampling.h"

namespace trocar::registration {

double bright_gray(const volume::LabelGrid& gray) {
  constexpr double kShare = 0.995, kLeast = 32.0;
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t level : gray.voxels) ++counts[level];
  const std::size_t total = gray.voxels.size() - counts[0];
  std::size_t below = 0;
  for (std::size_t level = 1; total > 0 && level < counts.size(); ++level) {
    below += counts[level];
    if (static_cast<double>(below) >= kShare * static_cast<double>(total))
      return std::max(kLeast, static_cast<double>(level));
  }
  return 255.0;
}

namespace {

constexpr std::int64_t kBlock = 4;  ///< Voxels along an edge of a block of the coarse grid.
constexpr float kTinyWeight = 1e-6F;
constexpr double kLeastDeviation = 0.25;  ///< Of that of the whole volume: plain regions are not amplified further.

/// Sums over blocks of voxels: weights, gray levels and their squares.
struct BlockSums {
  volume::FloatGrid weight, sum, squares;
};

volume::GridGeometry block_geometry(const volume::GridGeometry& fine) {
  volume::GridGeometry coarse = fine;
  for (auto& size : coarse.size) size = (size + kBlock - 1) / kBlock;
  coarse.spacing_mm = fine.spacing_mm * static_cast<double>(kBlock);
  coarse.origin_P = fine.to_mm(Vec3::Constant(0.5 * static_cast<double>(kBlock - 1)));
  return coarse;
}

BlockSums sum_blocks(const volume::LabelGrid& gray, const volume::MaskGrid& usable) {
  const volume::GridGeometry coarse = block_geometry(gray.geometry);
  BlockSums moments{volume::FloatGrid(coarse), volume::FloatGrid(coarse), volume::FloatGrid(coarse)};
  const auto& size = gray.geometry.size;
  parallel_for(static_cast<std::size_t>(coarse.size[2]), 1, [&](std::size_t first, std::size_t last) {
    const std::int64_t end = std::min(size[2], static_cast<std::int64_t>(last) * kBlock);
    for (std::int64_t k = static_cast<std::int64_t>(first) * kBlock; k < end; ++k) {
      for (std::int64_t j = 0; j < size[1]; ++j) {
        for (std::int64_t i = 0; i < size[0]; ++i) {
          const std::size_t n = gray.geometry.offset({i, j, k});
          if (usable.voxels[n] == 0) continue;
          const std::size_t block = coarse.offset({i / kBlock, j / kBlock, k / kBlock});
          const auto g = static_cast<float>(gray.voxels[n]);
          moments.weight.voxels[block] += 1.0F;
          moments.sum.voxels[block] += g;
          moments.squares.voxels[block] += g * g;
        }
      }
    }
  });
  return moments;
}

double deviation_of(const BlockSums& moments, double& count) {
  double sum = 0.0, squares = 0.0;
  count = 0.0;
  for (std::size_t n = 0; n < moments.sum.voxels.size(); ++n) {
    count += static_cast<double>(moments.weight.voxels[n]);
    sum += static_cast<double>(moments.sum.voxels[n]);
    squares += static_cast<double>(moments.squares.voxels[n]);
  }
  return count > 0.0 ? std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count))) : 0.0;
}

}  // namespace

Result<volume::FloatGrid> flatten(const volume::LabelGrid& gray, const volume::MaskGrid& usable, double sigma_mm) {
  TROCAR_CHECK(usable.voxels.size() == gray.voxels.size());
  BlockSums moments = sum_blocks(gray, usable);
  double count = 0.0;
  const double deviation = deviation_of(moments, count);
  if (count == 0.0)
    return fail("no voxel is usable: all are in shadow or outside of the fan", {},
                "check the beam axis and the shadow threshold");
  if (deviation < 1e-3) return fail("all usable voxels have the same gray level", {}, "give a volume with an image");
  const Vec3 sigma = sigma_mm * moments.sum.geometry.spacing_mm.cwiseInverse();
  for (volume::FloatGrid* grid : {&moments.weight, &moments.sum, &moments.squares}) volume::gaussian_blur(*grid, sigma);
  volume::FloatGrid mean(moments.sum.geometry), scale(moments.sum.geometry);
  for (std::size_t n = 0; n < mean.voxels.size(); ++n) {
    const float weight = std::max(moments.weight.voxels[n], kTinyWeight);
    mean.voxels[n] = moments.sum.voxels[n] / weight;
    const float variance = moments.squares.voxels[n] / weight - mean.voxels[n] * mean.voxels[n];
    const double local = std::sqrt(std::max(0.0, static_cast<double>(variance)));
    scale.voxels[n] = static_cast<float>(1.0 / std::max(local, kLeastDeviation * deviation));
  }
  volume::FloatGrid flat(gray.geometry);
  parallel_for(flat.voxels.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      if (usable.voxels[n] == 0) continue;
      const Vec3 at = (volume::to_vec3(gray.geometry.index_of(n)).array() - 0.5 * static_cast<double>(kBlock - 1)) /
                      static_cast<double>(kBlock);
      flat.voxels[n] = static_cast<float>((gray.voxels[n] - volume::sample_linear_at_index(mean, at)) *
                                          volume::sample_linear_at_index(scale, at));
    }
  });
  return flat;
}

volume::FloatGrid smooth_usable(const volume::FloatGrid& values, const volume::MaskGrid& usable, double sigma_mm) {
  volume::FloatGrid sum(values.geometry), weight(values.geometry);
  for (std::size_t n = 0; n < values.voxels.size(); ++n) {
    if (usable.voxels[n] == 0) continue;
    sum.voxels[n] = values.voxels[n];
    weight.voxels[n] = 1.0F;
  }
  const Vec3 sigma_voxels = sigma_mm * values.geometry.spacing_mm.cwiseInverse();
  volume::gaussian_blur(sum, sigma_voxels);
  volume::gaussian_blur(weight, sigma_voxels);
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  parallel_for(sum.voxels.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      sum.voxels[n] = usable.voxels[n] != 0 && weight.voxels[n] > 0.0F ? sum.voxels[n] / weight.voxels[n] : kNothing;
  });
  return sum;
}

}  // namespace trocar::registration
