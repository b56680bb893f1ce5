#include "registration/sift3d/scale_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "core/result.h"
#include "volume/resample.h"
#include "volume/sampling.h"

namespace trocar::registration {
namespace {

constexpr double kSourceSigma_voxels = 0.5;  ///< Blur of a sampled volume (Lowe 2004).
constexpr float kLeastWeight = 0.4F;
constexpr std::int64_t kLeastSize = 12;  ///< Voxels along the shortest axis of an octave.
constexpr double kSameSpacing = 0.01;    ///< Relative.

/// Sum of usable gray levels and of weights near a voxel: their quotient is the mean of the usable ones.
struct WeightedMean {
  volume::FloatGrid sum, weight;
};

Status check(const ScaleSpaceOptions& options) {
  const auto fail_at = [](const char* what, double value, const char* range) {
    return fail_usage(fmt::format("{} is out of range", what), fmt::format("{:g}", value), range);
  };
  if (!(options.first_sigma >= 0.8 && options.first_sigma <= 4.0))
    return fail_at("the first sigma", options.first_sigma, "give 0.8 to 4 voxels");
  if (options.scales < 1 || options.scales > 8) return fail_at("the number of scales", options.scales, "give 1 to 8");
  if (options.octaves < 1 || options.octaves > 8)
    return fail_at("the number of octaves", options.octaves, "give 1 to 8");
  if (!(options.spacing_mm == 0.0 || (options.spacing_mm >= 0.01 && options.spacing_mm <= 100.0)))
    return fail_at("the spacing", options.spacing_mm, "give 0.01 to 100 mm, or 0");
  return {};
}

WeightedMean weigh(const volume::FloatGrid& flat, const volume::MaskGrid& usable) {
  WeightedMean result{volume::FloatGrid(flat.geometry), volume::FloatGrid(flat.geometry)};
  parallel_for(flat.voxels.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      if (usable.voxels[n] == 0) continue;
      result.sum.voxels[n] = flat.voxels[n];
      result.weight.voxels[n] = 1.0F;
    }
  });
  return result;
}

void blur(WeightedMean& mean, const Vec3& sigma_voxels) {
  volume::gaussian_blur(mean.sum, sigma_voxels);
  volume::gaussian_blur(mean.weight, sigma_voxels);
}

volume::FloatGrid resample(const volume::FloatGrid& source, const volume::GridGeometry& target) {
  volume::FloatGrid result(target);
  parallel_for(result.voxels.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      result.voxels[n] = static_cast<float>(volume::sample_linear(source, target.centre_mm(target.index_of(n))));
  });
  return result;
}

/// First level of the first octave, on an isotropic grid. Sets the mask on that grid.
WeightedMean make_base(WeightedMean mean, const volume::MaskGrid& usable, double spacing_mm, double first_sigma,
                       volume::MaskGrid& mask) {
  const volume::GridGeometry& source = mean.sum.geometry;
  const double sigma_mm = first_sigma * spacing_mm;
  Vec3 sigma_voxels;
  for (int a = 0; a < 3; ++a) {
    const double wanted = sigma_mm / source.spacing_mm[a];
    sigma_voxels[a] = std::sqrt(std::max(0.0, wanted * wanted - kSourceSigma_voxels * kSourceSigma_voxels));
  }
  blur(mean, sigma_voxels);
  mask = usable;
  if (((source.spacing_mm.array() / spacing_mm - 1.0).abs() < kSameSpacing).all()) return mean;
  const volume::GridGeometry target = volume::isotropic_geometry(source, spacing_mm);
  mask = volume::resample_nearest(usable, target, 0);
  return {resample(mean.sum, target), resample(mean.weight, target)};
}

volume::FloatGrid quotient(const WeightedMean& mean, const volume::MaskGrid& mask) {
  volume::FloatGrid level(mean.sum.geometry);
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  parallel_for(level.voxels.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const float weight = mean.weight.voxels[n];
      level.voxels[n] = mask.voxels[n] != 0 && weight >= kLeastWeight ? mean.sum.voxels[n] / weight : kNothing;
    }
  });
  return level;
}

/// Every second voxel.
template <class T>
volume::Grid<T> halve(const volume::Grid<T>& grid) {
  volume::GridGeometry half = grid.geometry;
  for (auto& size : half.size) size = (size + 1) / 2;
  half.spacing_mm *= 2.0;
  volume::Grid<T> result(half);
  for (std::size_t n = 0; n < result.voxels.size(); ++n) {
    const volume::Index3 ijk = half.index_of(n);
    result.voxels[n] = grid[{2 * ijk[0], 2 * ijk[1], 2 * ijk[2]}];
  }
  return result;
}

/// Adds the levels of an octave; `mean` is its first level and becomes the first of the next.
Octave make_octave(WeightedMean& mean, volume::MaskGrid& mask, const ScaleSpaceOptions& options) {
  Octave octave;
  octave.geometry = mean.sum.geometry;
  octave.levels.push_back(quotient(mean, mask));
  WeightedMean next;
  for (int level = 1; level < options.scales + 3; ++level) {
    const double before = options.first_sigma * std::exp2(static_cast<double>(level - 1) / options.scales);
    const double now = options.first_sigma * std::exp2(static_cast<double>(level) / options.scales);
    blur(mean, Vec3::Constant(std::sqrt(now * now - before * before)));
    octave.levels.push_back(quotient(mean, mask));
    if (level == options.scales) next = {halve(mean.sum), halve(mean.weight)};
  }
  mean = std::move(next);
  mask = halve(mask);
  return octave;
}

}  // namespace

double ScaleSpace::sigma_mm(std::size_t octave, double level) const noexcept {
  return octaves[octave].geometry.spacing_mm.x() * options.first_sigma * std::exp2(level / options.scales);
}

Result<ScaleSpace> build_scale_space(const volume::FloatGrid& flat, const volume::MaskGrid& usable,
                                     const ScaleSpaceOptions& options) {
  TROCAR_CHECK(usable.voxels.size() == flat.voxels.size());
  TROCAR_TRY_STATUS(check(options));
  const double spacing_mm = options.spacing_mm > 0.0 ? options.spacing_mm : std::cbrt(flat.geometry.voxel_volume_mm3());
  volume::MaskGrid mask;
  WeightedMean mean = make_base(weigh(flat, usable), usable, spacing_mm, options.first_sigma, mask);
  ScaleSpace space;
  space.options = options;
  for (int octave = 0; octave < options.octaves; ++octave) {
    const auto& size = mean.sum.geometry.size;
    if (octave > 0 && std::min({size[0], size[1], size[2]}) < kLeastSize) break;
    space.octaves.push_back(make_octave(mean, mask, options));
  }
  return space;
}

}  // namespace trocar::registration
