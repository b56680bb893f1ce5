#include "registration/panorama/blend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/parallel.h"
#include "registration/intensity/gray_levels.h"
#include "volume/distance.h"
#include "volume/morphology.h"
#include "volume/sampling.h"

namespace trocar::registration::detail {

/// For each volume, the gray level of the first one (0..255) that corresponds to each of its own: equal ranks among the
/// usable voxels that a volume has in common with those before it. Volumes with little in common keep their levels.
std::vector<std::array<float, 256>> match_gray_levels(const std::vector<PlacedVolume>& volumes);

}  // namespace trocar::registration::detail

namespace trocar::registration {
namespace {

constexpr double kMaxVoxels = 512e6;
constexpr double kSmoothing_voxels = 3.0;  ///< Between the slowly varying gray level and speckle.

/// A volume's gray levels in two parts, and its weight at each voxel.
struct Layer {
  const PlacedVolume* placed = nullptr;
  Pose X_N0;
  volume::FloatGrid gray;    ///< Matched to the first volume.
  volume::FloatGrid smooth;  ///< Its slowly varying part; NaN where not usable.
  volume::FloatGrid weight;  ///< 0..1; 0 where not usable.
};

volume::FloatGrid weights_of(const PreparedVolume& volume, double margin_mm) {
  volume::MaskGrid unusable(volume.gray.geometry);
  for (std::size_t n = 0; n < unusable.voxels.size(); ++n)
    unusable.voxels[n] = volume.region.usable.voxels[n] != 0 ? 0 : 1;
  volume::FloatGrid weight = volume::distance_to_mask_mm(unusable);
  parallel_for(weight.voxels.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      if (unusable.voxels[n] != 0) {
        weight.voxels[n] = 0.0F;
        continue;
      }
      const Beams::Place place = volume.beams.to_place(weight.geometry.centre_mm(weight.geometry.index_of(n)));
      const double edge_mm = std::max(volume.beams.distance_to_edge_mm(place), 0.0);
      const double inside = std::min({static_cast<double>(weight.voxels[n]), edge_mm, margin_mm}) / margin_mm;
      const double aside = volume.beams.is_fan() ? std::cos(place.lateral) * std::cos(place.elevation) : 1.0;
      constexpr double kLeast = 0.01;  // the only volume at a place is used up to its edge
      weight.voxels[n] = static_cast<float>(std::max(kLeast, inside * aside));
    }
  });
  return weight;
}

Layer make_layer(const PlacedVolume& placed, const std::array<float, 256>& levels, double margin_mm) {
  Layer layer;
  layer.placed = &placed;
  layer.X_N0 = placed.X_0N.inverse();
  const PreparedVolume& volume = *placed.volume;
  layer.gray = volume::FloatGrid(volume.gray.geometry);
  for (std::size_t n = 0; n < layer.gray.voxels.size(); ++n) layer.gray.voxels[n] = levels[volume.gray.voxels[n]];
  const double sigma_mm = kSmoothing_voxels * volume.gray.geometry.spacing_mm.minCoeff();
  layer.smooth = smooth_usable(layer.gray, volume.region.usable, sigma_mm);
  layer.weight = weights_of(volume, margin_mm);
  return layer;
}

/// Smallest grid along the axes of the first volume that contains all volumes.
Result<volume::GridGeometry> lay_grid(const std::vector<PlacedVolume>& volumes, double spacing_mm) {
  const volume::GridGeometry& first = volumes.front().volume->gray.geometry;
  const Mat3 R_V0 = first.R_PV.transpose();
  Vec3 low = Vec3::Constant(1e9), high = Vec3::Constant(-1e9);
  for (const PlacedVolume& placed : volumes) {
    const auto& size = placed.volume->gray.geometry.size;
    for (int corner = 0; corner < 8; ++corner) {
      Vec3 index;
      for (int a = 0; a < 3; ++a)
        index[a] = ((corner >> a) & 1) != 0 ? static_cast<double>(size[static_cast<std::size_t>(a)] - 1) : 0.0;
      const Vec3 p = R_V0 * (placed.X_0N * placed.volume->gray.geometry.to_mm(index) - first.origin_P);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  volume::GridGeometry grid = first;
  if (spacing_mm > 0.0) grid.spacing_mm = Vec3::Constant(spacing_mm);
  const Vec3 begin = low.cwiseQuotient(grid.spacing_mm).array().floor();
  const Vec3 end = high.cwiseQuotient(grid.spacing_mm).array().ceil();
  double voxels = 1.0;
  for (int a = 0; a < 3; ++a) {
    grid.size[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(end[a] - begin[a]) + 1;
    voxels *= end[a] - begin[a] + 1.0;
  }
  if (voxels > kMaxVoxels)
    return fail_usage(fmt::format("the panorama would have {:.0f} million voxels", voxels * 1e-6), {},
                      "choose a larger spacing");
  grid.origin_P = first.origin_P + first.R_PV * begin.cwiseProduct(grid.spacing_mm);
  return grid;
}

bool is_within(const volume::GridGeometry& geometry, const Vec3& index) {
  for (int a = 0; a < 3; ++a)
    if (!(index[a] >= 0.0 && index[a] <= static_cast<double>(geometry.size[static_cast<std::size_t>(a)] - 1)))
      return false;
  return true;
}

/// Gray level of a voxel and the number of its main volume.
struct Mixed {
  double gray = 0.0;
  std::size_t source = 0;
  double seam = 0.0;  ///< Difference of the two main volumes' slow parts.
  bool is_seam = false;
};

/// Slow parts are mixed over the whole overlap; speckle in narrow seams, with its power kept.
Mixed mix_layers(const std::vector<Layer>& layers, const Vec3& p_0, double sharpness) {
  struct Part {
    double weight, gray, smooth;
    std::size_t source;
  };
  std::array<Part, 64> parts;
  std::size_t count = 0;
  double largest = 0.0;
  for (std::size_t n = 0; n < layers.size() && count < parts.size(); ++n) {
    const Layer& layer = layers[n];
    const Vec3 index = layer.weight.geometry.to_index(layer.X_N0 * p_0);
    if (!is_within(layer.weight.geometry, index)) continue;
    const double weight = volume::sample_linear_at_index(layer.weight, index);
    if (weight <= 0.0) continue;
    const double smooth = volume::sample_linear_at_index(layer.smooth, index);
    if (!(smooth == smooth)) continue;  // beside a shadow
    parts[count++] = {weight, volume::sample_linear_at_index(layer.gray, index), smooth, n + 1};
    largest = std::max(largest, weight);
  }
  Mixed mixed;
  if (count == 0) return mixed;
  double slow = 0.0, slow_weight = 0.0, fast = 0.0, power = 0.0;
  const Part* main = nullptr;
  const Part* second = nullptr;
  for (std::size_t n = 0; n < count; ++n) {
    const Part& part = parts[n];
    slow += part.weight * part.smooth;
    slow_weight += part.weight;
    const double sharp = std::pow(part.weight / largest, sharpness);
    fast += sharp * (part.gray - part.smooth);
    power += sharp * sharp;
    if (!main || part.weight > main->weight) {
      second = main;
      main = &part;
    } else if (!second || part.weight > second->weight) {
      second = &part;
    }
  }
  mixed.gray = slow / slow_weight + fast / std::sqrt(power);
  mixed.source = main->source;
  if (second && second->weight > 0.9 * main->weight) {
    mixed.is_seam = true;
    mixed.seam = std::abs(main->smooth - second->smooth);
  }
  return mixed;
}

/// Islands of imaged voxels between shadows, too small to show anything.
void remove_islands(Panorama& panorama) {
  constexpr std::size_t kLeast = 1000;  // voxels
  volume::MaskGrid imaged(panorama.gray.geometry);
  for (std::size_t n = 0; n < imaged.voxels.size(); ++n) imaged.voxels[n] = panorama.gray.voxels[n] != 0 ? 1 : 0;
  const volume::Components components = volume::connected_components(imaged);
  for (std::size_t n = 0; n < imaged.voxels.size(); ++n) {
    const std::int32_t id = components.ids.voxels[n];
    if (id == 0 || id == 1 || components.voxel_counts[static_cast<std::size_t>(id - 1)] >= kLeast) continue;
    panorama.gray.voxels[n] = 0;
    panorama.source.voxels[n] = 0;
  }
}

volume::LabelGrid crop(const volume::LabelGrid& grid, const volume::Index3& first, const volume::Index3& last) {
  volume::GridGeometry geometry = grid.geometry;
  for (std::size_t a = 0; a < 3; ++a) geometry.size[a] = last[a] - first[a] + 1;
  geometry.origin_P = grid.geometry.centre_mm(first);
  volume::LabelGrid cropped(geometry);
  for (std::size_t n = 0; n < cropped.voxels.size(); ++n) {
    const volume::Index3 ijk = geometry.index_of(n);
    cropped.voxels[n] = grid[{ijk[0] + first[0], ijk[1] + first[1], ijk[2] + first[2]}];
  }
  return cropped;
}

/// Cuts the grid to the imaged voxels and a margin of one.
void crop_to_imaged(Panorama& panorama) {
  const auto& size = panorama.gray.geometry.size;
  volume::Index3 first = size, last{0, 0, 0};
  for (std::size_t n = 0; n < panorama.gray.voxels.size(); ++n) {
    if (panorama.gray.voxels[n] == 0) continue;
    const volume::Index3 ijk = panorama.gray.geometry.index_of(n);
    for (std::size_t a = 0; a < 3; ++a) {
      first[a] = std::min(first[a], ijk[a]);
      last[a] = std::max(last[a], ijk[a]);
    }
  }
  if (first[0] > last[0]) return;
  for (std::size_t a = 0; a < 3; ++a) {
    first[a] = std::max<std::int64_t>(0, first[a] - 1);
    last[a] = std::min(size[a] - 1, last[a] + 1);
  }
  panorama.gray = crop(panorama.gray, first, last);
  panorama.source = crop(panorama.source, first, last);
}

}  // namespace

Result<Panorama> blend(const std::vector<PlacedVolume>& volumes, const BlendOptions& options,
                       const Progress& progress) {
  if (!(options.sharpness >= 1.0 && options.sharpness <= 20.0))
    return fail_usage("the sharpness of seams is out of range", fmt::format("{:g}", options.sharpness), "give 1 to 20");
  if (!(options.margin_mm >= 0.1 && options.margin_mm <= 100.0))
    return fail_usage("the margin of volumes is out of range", fmt::format("{:g}", options.margin_mm),
                      "give 0.1 to 100 mm");
  TROCAR_TRY(const volume::GridGeometry grid, lay_grid(volumes, options.spacing_mm));
  report(progress, "matching gray levels", 0.0);
  const auto levels = detail::match_gray_levels(volumes);
  std::vector<Layer> layers;
  for (std::size_t n = 0; n < volumes.size(); ++n) {
    report(progress, "weighting volumes", 0.1 + 0.4 * static_cast<double>(n) / static_cast<double>(volumes.size()));
    layers.push_back(make_layer(volumes[n], levels[n], options.margin_mm));
  }
  report(progress, "blending", 0.5);
  Panorama panorama{volume::LabelGrid(grid), volume::LabelGrid(grid), 0.0};
  const auto rows = static_cast<std::size_t>(grid.size[1] * grid.size[2]);
  const auto row = static_cast<std::size_t>(grid.size[0]);
  std::vector<double> seam(rows, 0.0), seam_count(rows, 0.0);
  parallel_for(rows, 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first * row; n < last * row; ++n) {
      const Mixed mixed = mix_layers(layers, grid.centre_mm(grid.index_of(n)), options.sharpness);
      if (mixed.source == 0) continue;
      panorama.gray.voxels[n] = static_cast<std::uint8_t>(std::clamp(std::lround(mixed.gray), 1L, 255L));
      panorama.source.voxels[n] = static_cast<std::uint8_t>(std::min<std::size_t>(mixed.source, 255));
      if (!mixed.is_seam) continue;
      seam[n / row] += mixed.seam;
      seam_count[n / row] += 1.0;
    }
  });
  double sum = 0.0, count = 0.0;
  for (std::size_t n = 0; n < rows; ++n) {
    sum += seam[n];
    count += seam_count[n];
  }
  panorama.seam_difference = count > 0.0 ? sum / count : 0.0;
  remove_islands(panorama);
  crop_to_imaged(panorama);
  report(progress, "done", 1.0);
  return panorama;
}

}  // namespace trocar::registration

namespace trocar::registration::detail {
namespace {

constexpr std::int64_t kStride = 2;      ///< Voxels between compared ones.
constexpr double kLeastCommon = 2000.0;  ///< Compared voxels.

using Counts = std::array<double, 256>;

/// Counts of gray levels at the places that two volumes have in common.
struct CommonCounts {
  Counts own{}, other{};
};

void count_common(const PlacedVolume& own, const PlacedVolume& other, const std::array<float, 256>& other_levels,
                  CommonCounts& counts) {
  const Pose X_OtherOwn = other.X_0N.inverse() * own.X_0N;
  const auto& geometry = own.volume->gray.geometry;
  for (std::int64_t k = 0; k < geometry.size[2]; k += kStride) {
    for (std::int64_t j = 0; j < geometry.size[1]; j += kStride) {
      for (std::int64_t i = 0; i < geometry.size[0]; i += kStride) {
        const std::size_t n = geometry.offset({i, j, k});
        if (own.volume->region.usable.voxels[n] == 0) continue;
        const Vec3 p = X_OtherOwn * geometry.centre_mm({i, j, k});
        if (volume::sample_nearest(other.volume->region.usable, p, std::uint8_t{0}) == 0) continue;
        counts.own[own.volume->gray.voxels[n]] += 1.0;
        const float level = other_levels[volume::sample_nearest(other.volume->gray, p, std::uint8_t{0})];
        counts.other[static_cast<std::size_t>(std::clamp(level + 0.5F, 0.0F, 255.0F))] += 1.0;
      }
    }
  }
}

/// The level of `other` below which the same share of voxels lies as below each level of `own`, half of the level's
/// own included.
std::array<float, 256> levels_of_equal_rank(const CommonCounts& counts) {
  const double total = std::accumulate(counts.own.begin(), counts.own.end(), 0.0);
  std::array<float, 256> levels{};
  double own_below = 0.0, other_below = 0.0;
  std::size_t other = 0;
  for (std::size_t g = 0; g < 256; ++g) {
    const double rank = own_below + 0.5 * counts.own[g];
    while (other < 255 && other_below + counts.other[other] < rank) other_below += counts.other[other++];
    const double within = counts.other[other] > 0.0 ? (rank - other_below) / counts.other[other] - 0.5 : 0.0;
    levels[g] = total > 0.0 ? static_cast<float>(static_cast<double>(other) + within) : static_cast<float>(g);
    own_below += counts.own[g];
  }
  // Levels that do not occur in common continue with the nearest that do.
  for (std::size_t g = 1; g < 256; ++g) levels[g] = std::max(levels[g], levels[g - 1]);
  return levels;
}

}  // namespace

std::vector<std::array<float, 256>> match_gray_levels(const std::vector<PlacedVolume>& volumes) {
  std::array<float, 256> same{};
  std::iota(same.begin(), same.end(), 0.0F);
  std::vector<std::array<float, 256>> levels(volumes.size(), same);
  for (std::size_t n = 1; n < volumes.size(); ++n) {
    CommonCounts counts;
    for (std::size_t other = 0; other < n; ++other) count_common(volumes[n], volumes[other], levels[other], counts);
    if (std::accumulate(counts.own.begin(), counts.own.end(), 0.0) >= kLeastCommon)
      levels[n] = levels_of_equal_rank(counts);
  }
  return levels;
}

}  // namespace trocar::registration::detail
