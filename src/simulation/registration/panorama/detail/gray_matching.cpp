#include "registration/panorama/detail/gray_matching.h"

#include <algorithm>
#include <numeric>

#include "volume/sampling.h"

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
