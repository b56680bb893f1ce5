#include "registration/ct_ultrasound/detail/working_images.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>

#include "core/random.h"
#include "registration/ct_ultrasound/detail/smoothing.h"
#include "registration/shadow/shadow_mask.h"
#include "volume/morphology.h"

namespace trocar::registration::detail {
namespace {

/// docs/physics.md R11; all assumed, chosen on simulated sweeps.
constexpr double kWorking_mm = 1.6;         ///< Blocks of voxels are at most this long.
constexpr double kShadowShareOfOtsu = 0.4;  ///< Deep tissue is darker than Otsu's threshold; shadow is darker still.
constexpr double kWidening_mm = 3.5;        ///< Of shadows and edges.
constexpr double kContrast_mm = 12.0;       ///< Standard deviation of the surroundings of local contrast.
constexpr float kFurthestContrast = 3.0F;   ///< Local contrast is limited to this many standard deviations.
constexpr float kGrayFloor = 3.0F;          ///< Added to the local deviation: gray levels, HU.
constexpr float kHuFloor = 15.0F;
constexpr float kLowest_hu = -150.0F, kHighest_hu = 250.0F;
constexpr double kMargin_mm = 45.0;  ///< CT around the ultrasound.
constexpr std::size_t kFewestUsable = 4000;
constexpr double kFewestUsableShare = 0.02;

volume::Index3 factors_of(const Vec3& spacing_mm, double target_mm) {
  volume::Index3 factors{};
  for (std::size_t a = 0; a < 3; ++a)
    factors[a] = std::max<std::int64_t>(1, static_cast<std::int64_t>(target_mm / spacing_mm[static_cast<int>(a)]));
  return factors;
}

template <class T>
volume::FloatGrid every_block(const volume::Grid<T>& grid, std::int64_t factor) {
  return block_means(grid, {0, 0, 0}, grid.geometry.size, {factor, factor, factor});
}

/// Position of a voxel in a grid of blocks, along one axis.
struct BlockPosition {
  std::size_t low = 0, high = 0;
  float share = 0.0F;  ///< Of `high`.
};

/// Positions of all voxels of an axis.
std::vector<BlockPosition> block_positions(std::int64_t voxels, std::int64_t factor, std::int64_t blocks) {
  std::vector<BlockPosition> positions;
  for (std::int64_t n = 0; n < voxels; ++n) {
    const double at = (static_cast<double>(n) - 0.5 * static_cast<double>(factor - 1)) / static_cast<double>(factor);
    const double inside = std::clamp(at, 0.0, static_cast<double>(blocks - 1));
    const auto low = static_cast<std::int64_t>(inside);
    positions.push_back({static_cast<std::size_t>(low), static_cast<std::size_t>(std::min(low + 1, blocks - 1)),
                         static_cast<float>(inside - static_cast<double>(low))});
  }
  return positions;
}

float mix(float a, float b, float share) {
  return a + share * (b - a);
}

/// Values of a grid of blocks along i, bilinear between its rows.
void interpolate_row(const volume::FloatGrid& blocks, const BlockPosition& j, const BlockPosition& k,
                     std::span<float> line) {
  const auto row = [&](std::size_t at_j, std::size_t at_k) {
    return &blocks[{0, static_cast<std::int64_t>(at_j), static_cast<std::int64_t>(at_k)}];
  };
  const float *near_low = row(j.low, k.low), *near_high = row(j.high, k.low);
  const float *far_low = row(j.low, k.high), *far_high = row(j.high, k.high);
  for (std::size_t i = 0; i < line.size(); ++i)
    line[i] = mix(mix(near_low[i], near_high[i], j.share), mix(far_low[i], far_high[i], j.share), k.share);
}

/// Mean of the surroundings, and 1 over what a deviation from it is divided by; on a grid of blocks.
struct Surroundings {
  volume::Index3 factors{};
  volume::FloatGrid mean, scale;
};

/// Sums of weights, of weighted values and of their squares over blocks.
template <class Weight>
std::array<volume::FloatGrid, 3> sum_weighted_blocks(const volume::FloatGrid& grid, const Weight& weight,
                                                     const volume::Index3& factors) {
  volume::GridGeometry geometry = grid.geometry;
  for (std::size_t a = 0; a < 3; ++a) {
    geometry.size[a] /= factors[a];
    geometry.spacing_mm[static_cast<int>(a)] *= static_cast<double>(factors[a]);
  }
  std::array<volume::FloatGrid, 3> sums{volume::FloatGrid(geometry), volume::FloatGrid(geometry),
                                        volume::FloatGrid(geometry)};
  const auto width = static_cast<std::size_t>(factors[0]);
  parallel_for(static_cast<std::size_t>(geometry.size[2]), 1, [&](std::size_t begin, std::size_t end) {
    const auto last_k = static_cast<std::int64_t>(end) * factors[2];
    for (std::int64_t k = static_cast<std::int64_t>(begin) * factors[2]; k < last_k; ++k)
      for (std::int64_t j = 0; j < geometry.size[1] * factors[1]; ++j) {
        std::size_t n = grid.geometry.offset({0, j, k});
        const std::size_t row = geometry.offset({0, j / factors[1], k / factors[2]});
        for (std::size_t block = row; block < row + static_cast<std::size_t>(geometry.size[0]); ++block) {
          float weights = 0.0F, values = 0.0F, squares = 0.0F;
          for (const std::size_t stop = n + width; n < stop; ++n) {
            const float w = weight(n), v = grid.voxels[n];
            weights += w;
            values += w * v;
            squares += w * v * v;
          }
          sums[0].voxels[block] += weights;
          sums[1].voxels[block] += values;
          sums[2].voxels[block] += squares;
        }
      }
  });
  return sums;
}

template <class Weight>
Surroundings find_surroundings(const volume::FloatGrid& grid, const Weight& weight, float floor) {
  Surroundings around;
  around.factors = factors_of(grid.geometry.spacing_mm, 0.5 * kContrast_mm);
  for (std::size_t a = 0; a < 3; ++a) around.factors[a] = std::min(around.factors[a], grid.geometry.size[a]);
  auto [weights, values, squares] = sum_weighted_blocks(grid, weight, around.factors);
  for (volume::FloatGrid* sums : {&weights, &values, &squares}) smooth(*sums, kContrast_mm);
  const auto per_block = static_cast<float>(around.factors[0] * around.factors[1] * around.factors[2]);
  around.mean = volume::FloatGrid(weights.geometry);
  around.scale = volume::FloatGrid(weights.geometry);
  for (std::size_t n = 0; n < weights.voxels.size(); ++n) {
    const float sum = std::max(weights.voxels[n], 1e-3F * per_block);
    const float mean = values.voxels[n] / sum;
    around.mean.voxels[n] = mean;
    around.scale.voxels[n] = 1.0F / (std::sqrt(std::max(squares.voxels[n] / sum - mean * mean, 0.0F)) + floor);
  }
  return around;
}

/// Local contrast (R11). `weight(n)`: of voxel n.
template <class Weight>
void to_local_contrast(volume::FloatGrid& grid, const Weight& weight, float floor) {
  const Surroundings around = find_surroundings(grid, weight, floor);
  const auto& size = grid.geometry.size;
  const auto& few = around.mean.geometry.size;
  std::array<std::vector<BlockPosition>, 3> positions;
  for (std::size_t a = 0; a < 3; ++a) positions[a] = block_positions(size[a], around.factors[a], few[a]);
  parallel_for(static_cast<std::size_t>(size[1] * size[2]), 32, [&](std::size_t begin, std::size_t end) {
    std::vector<float> mean(static_cast<std::size_t>(few[0])), scale(static_cast<std::size_t>(few[0]));
    for (std::size_t row = begin; row < end; ++row) {
      const BlockPosition& j = positions[1][row % positions[1].size()];
      const BlockPosition& k = positions[2][row / positions[1].size()];
      interpolate_row(around.mean, j, k, mean);
      interpolate_row(around.scale, j, k, scale);
      float* out = grid.voxels.data() + row * positions[0].size();
      for (const BlockPosition& i : positions[0]) {
        const float contrast =
            (*out - mix(mean[i.low], mean[i.high], i.share)) * mix(scale[i.low], scale[i.high], i.share);
        *out++ = std::clamp(contrast, -kFurthestContrast, kFurthestContrast);
      }
    }
  });
}

std::uint32_t count_of_row(std::span<const std::uint8_t> row) {
  std::uint32_t count = 0;
  for (const std::uint8_t voxel : row) count += voxel;
  return count;
}

/// Count, sum and sum of squares of the indices i of a row's usable voxels.
struct RowSums {
  std::uint32_t count = 0, sum = 0;
  std::uint64_t squares = 0;
};

RowSums sums_of_row(std::span<const std::uint8_t> row) {
  RowSums sums;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::uint32_t here = row[i] != 0 ? static_cast<std::uint32_t>(i) : 0U;
    sums.count += row[i] != 0 ? 1U : 0U;
    sums.sum += here;
    sums.squares += static_cast<std::uint64_t>(here) * here;
  }
  return sums;
}

void find_centre(WorkingUltrasound& us) {
  const volume::GridGeometry& geometry = us.usable.geometry;
  const auto length = static_cast<std::size_t>(geometry.size[0]);
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();  // of indices
  for (std::size_t row = 0; row * length < us.usable.voxels.size(); ++row) {
    const RowSums sums = sums_of_row(std::span(us.usable.voxels).subspan(row * length, length));
    const auto count = static_cast<double>(sums.count);
    const Vec3 at = volume::to_vec3(geometry.index_of(row * length));
    us.usable_count += sums.count;
    sum += Vec3(static_cast<double>(sums.sum), count * at[1], count * at[2]);
    squares += Vec3(static_cast<double>(sums.squares), count * at[1] * at[1], count * at[2] * at[2]);
  }
  if (us.usable_count == 0) return;
  const Vec3 mean = sum / static_cast<double>(us.usable_count);
  const Vec3 variance = squares / static_cast<double>(us.usable_count) - mean.cwiseAbs2();
  us.centre = geometry.to_mm(mean);
  us.radius_mm = std::sqrt(std::max(1.0, variance.dot(geometry.spacing_mm.cwiseAbs2())));
}

}  // namespace

Result<WorkingUltrasound> prepare_ultrasound(const volume::LabelGrid& gray, const Beams& beams) {
  WorkingUltrasound us;
  us.gray = block_means(gray, {0, 0, 0}, gray.geometry.size, factors_of(gray.geometry.spacing_mm, kWorking_mm));
  volume::LabelGrid rounded(us.gray.geometry);
  for (std::size_t n = 0; n < rounded.voxels.size(); ++n)
    rounded.voxels[n] = static_cast<std::uint8_t>(us.gray.voxels[n] + 0.5F);
  us.inside = imaged_voxels(rounded, beams);
  TROCAR_TRY(const double otsu, estimate_shadow_threshold(std::span(&rounded, 1), std::span(&us.inside, 1)));
  TROCAR_TRY(ImagedRegion region, find_shadows(rounded, beams, std::max(1.0, kShadowShareOfOtsu * otsu)));
  us.inside = std::move(region.inside);
  us.lit = std::move(region.usable);
  us.shadow_share = region.shadow_share;
  us.usable = volume::erode(us.lit, kWidening_mm);
  find_centre(us);
  const auto fewest = static_cast<std::size_t>(kFewestUsableShare * static_cast<double>(us.usable.voxels.size()));
  if (us.usable_count < std::min(kFewestUsable, std::max<std::size_t>(fewest, 500)))
    return fail(fmt::format("{} of {} voxels of the ultrasound show tissue: the rest is shadow or not imaged",
                            us.usable_count, us.usable.voxels.size()),
                {}, "check the beam axis, or give a volume with more tissue");
  return us;
}

volume::FloatGrid prepare_ct(const volume::CtGrid& ct, const Vec3& centre_C, double radius_mm) {
  const volume::GridGeometry& geometry = ct.geometry;
  const Vec3 centre = geometry.to_index(centre_C);
  volume::Index3 first{}, size{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    const double reach = (2.0 * radius_mm + kMargin_mm) / geometry.spacing_mm[axis];
    const auto last = static_cast<double>(geometry.size[a] - 1);
    first[a] = static_cast<std::int64_t>(std::clamp(centre[axis] - reach, 0.0, last));
    size[a] = static_cast<std::int64_t>(std::clamp(centre[axis] + reach, 0.0, last)) - first[a] + 1;
  }
  volume::FloatGrid result = block_means(ct, first, size, factors_of(geometry.spacing_mm, kWorking_mm));
  for (float& hu : result.voxels) hu = std::clamp(hu, kLowest_hu, kHighest_hu);
  return result;
}

Level make_level(const WorkingUltrasound& us, const volume::FloatGrid& ct_U, double us_sigma_mm, double ct_sigma_mm,
                 std::int64_t factor) {
  // Gray levels beside the image do not count: both sums are smoothed and divided.
  volume::FloatGrid sum = us.gray;
  for (std::size_t n = 0; n < sum.voxels.size(); ++n) sum.voxels[n] *= static_cast<float>(us.inside.voxels[n]);
  Level level{every_block(sum, factor), every_block(ct_U, factor)};
  volume::FloatGrid weights = every_block(us.inside, factor);
  smooth(level.us, us_sigma_mm);
  smooth(weights, us_sigma_mm);
  for (std::size_t n = 0; n < level.us.voxels.size(); ++n) level.us.voxels[n] /= std::max(weights.voxels[n], 1e-3F);
  const volume::FloatGrid lit = every_block(us.lit, factor);
  to_local_contrast(
      level.us, [&](std::size_t n) { return lit.voxels[n]; }, kGrayFloor);
  smooth(level.ct, ct_sigma_mm);
  to_local_contrast(
      level.ct, [](std::size_t) { return 1.0F; }, kHuFloor);
  return level;
}

std::vector<Vec3> sample_usable(const WorkingUltrasound& us, std::size_t count, std::uint64_t seed) {
  const volume::GridGeometry& geometry = us.usable.geometry;
  const auto length = static_cast<std::size_t>(geometry.size[0]);
  const double stride = std::max(1.0, static_cast<double>(us.usable_count) / static_cast<double>(count));
  Random random(seed);
  std::vector<Vec3> points;
  points.reserve(count + 1);
  std::size_t before = 0;  // usable voxels of the rows before
  auto next = static_cast<std::size_t>(stride * random.uniform());
  for (std::size_t row = 0; row * length < us.usable.voxels.size(); ++row) {
    const auto voxels = std::span(us.usable.voxels).subspan(row * length, length);
    const std::size_t after = before + count_of_row(voxels);
    const Vec3 start = volume::to_vec3(geometry.index_of(row * length));
    for (std::size_t i = 0; next < after; ++i) {
      if (voxels[i] == 0 || before++ < next) continue;
      const Vec3 within(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
      points.push_back(geometry.to_mm(start + Vec3(static_cast<double>(i), 0.0, 0.0) + within));
      next =
          std::max(before, static_cast<std::size_t>(stride * (static_cast<double>(points.size()) + random.uniform())));
    }
    before = after;
  }
  return points;
}

}  // namespace trocar::registration::detail
