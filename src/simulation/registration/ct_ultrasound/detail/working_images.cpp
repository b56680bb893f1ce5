#include "registration/ct_ultrasound/detail/working_images.h"

#include <fmt/format.h>

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

volume::FloatGrid every_block(const volume::FloatGrid& grid, std::int64_t factor) {
  if (factor == 1) return grid;
  return block_means(grid, {0, 0, 0}, grid.geometry.size, {factor, factor, factor});
}

/// Position of a voxel in a grid of blocks, along one axis.
struct BlockPosition {
  std::int64_t low = 0, high = 0;
  float share = 0.0F;  ///< Of `high`.
};

BlockPosition block_position(std::int64_t n, std::int64_t factor, std::int64_t count) {
  const double at = (static_cast<double>(n) - 0.5 * static_cast<double>(factor - 1)) / static_cast<double>(factor);
  const double inside = std::clamp(at, 0.0, static_cast<double>(count - 1));
  const auto low = static_cast<std::int64_t>(inside);
  return {low, std::min(low + 1, count - 1), static_cast<float>(inside - static_cast<double>(low))};
}

/// Trilinear values of a grid of blocks along a row of its voxels.
void interpolate_row(const volume::FloatGrid& blocks, const BlockPosition& j, const BlockPosition& k,
                     std::int64_t factor, std::vector<float>& line, std::vector<float>& row) {
  const std::int64_t count = blocks.geometry.size[0];
  line.resize(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    const float low = blocks[{i, j.low, k.low}] * (1.0F - j.share) + blocks[{i, j.high, k.low}] * j.share;
    const float high = blocks[{i, j.low, k.high}] * (1.0F - j.share) + blocks[{i, j.high, k.high}] * j.share;
    line[static_cast<std::size_t>(i)] = low * (1.0F - k.share) + high * k.share;
  }
  for (std::size_t i = 0; i < row.size(); ++i) {
    const BlockPosition at = block_position(static_cast<std::int64_t>(i), factor, count);
    row[i] =
        line[static_cast<std::size_t>(at.low)] * (1.0F - at.share) + line[static_cast<std::size_t>(at.high)] * at.share;
  }
}

/// Mean of the surroundings, and what a deviation from it is divided by; on a grid of blocks.
struct Surroundings {
  volume::Index3 factors{};
  volume::FloatGrid mean, deviation;
};

Surroundings find_surroundings(const volume::FloatGrid& grid, const volume::FloatGrid& weight, float floor) {
  Surroundings around;
  around.factors = factors_of(grid.geometry.spacing_mm, 0.5 * kContrast_mm);
  volume::FloatGrid first(grid.geometry), second(grid.geometry);
  for (std::size_t n = 0; n < grid.voxels.size(); ++n) {
    first.voxels[n] = weight.voxels[n] * grid.voxels[n];
    second.voxels[n] = first.voxels[n] * grid.voxels[n];
  }
  const auto spread = [&](const volume::FloatGrid& g) {
    volume::FloatGrid means = block_means(g, {0, 0, 0}, g.geometry.size, around.factors);
    smooth(means, kContrast_mm);
    return means;
  };
  const volume::FloatGrid sums = spread(weight), squares = spread(second);
  around.mean = spread(first);
  around.deviation = volume::FloatGrid(sums.geometry);
  for (std::size_t n = 0; n < sums.voxels.size(); ++n) {
    const float sum = std::max(sums.voxels[n], 1e-3F);
    around.mean.voxels[n] /= sum;
    const float mean = around.mean.voxels[n];
    around.deviation.voxels[n] = std::sqrt(std::max(squares.voxels[n] / sum - mean * mean, 0.0F)) + floor;
  }
  return around;
}

/// Local contrast (R11).
void to_local_contrast(volume::FloatGrid& grid, const volume::FloatGrid& weight, float floor) {
  const Surroundings around = find_surroundings(grid, weight, floor);
  const auto& size = grid.geometry.size;
  const auto& few = around.mean.geometry.size;
  parallel_for(static_cast<std::size_t>(size[1] * size[2]), 32, [&](std::size_t begin, std::size_t end) {
    std::vector<float> line, mean(static_cast<std::size_t>(size[0])), deviation(static_cast<std::size_t>(size[0]));
    for (std::size_t r = begin; r < end; ++r) {
      const auto row = static_cast<std::int64_t>(r);
      const BlockPosition j = block_position(row % size[1], around.factors[1], few[1]);
      const BlockPosition k = block_position(row / size[1], around.factors[2], few[2]);
      interpolate_row(around.mean, j, k, around.factors[0], line, mean);
      interpolate_row(around.deviation, j, k, around.factors[0], line, deviation);
      float* out = grid.voxels.data() + row * size[0];
      for (std::size_t i = 0; i < mean.size(); ++i)
        out[i] = std::clamp((out[i] - mean[i]) / deviation[i], -kFurthestContrast, kFurthestContrast);
    }
  });
}

volume::FloatGrid to_float(const volume::MaskGrid& mask) {
  volume::FloatGrid result(mask.geometry);
  std::copy(mask.voxels.begin(), mask.voxels.end(), result.voxels.begin());
  return result;
}

void find_centre(WorkingUltrasound& us) {
  const volume::GridGeometry& geometry = us.usable.geometry;
  Vec3 sum = Vec3::Zero();
  double squares = 0.0;
  for (std::size_t n = 0; n < us.usable.voxels.size(); ++n) {
    if (us.usable.voxels[n] == 0) continue;
    const Vec3 p = geometry.centre_mm(geometry.index_of(n));
    sum += p;
    squares += p.squaredNorm();
    ++us.usable_count;
  }
  if (us.usable_count == 0) return;
  us.centre = sum / static_cast<double>(us.usable_count);
  us.radius_mm = std::sqrt(std::max(1.0, squares / static_cast<double>(us.usable_count) - us.centre.squaredNorm()));
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
                {}, "check --beam-axis, or give a volume with more tissue");
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
  volume::FloatGrid weight = to_float(us.inside);
  volume::FloatGrid sum = us.gray;
  for (std::size_t n = 0; n < sum.voxels.size(); ++n) sum.voxels[n] *= weight.voxels[n];
  Level level{every_block(sum, factor), every_block(ct_U, factor)};
  volume::FloatGrid weights = every_block(weight, factor);
  smooth(level.us, us_sigma_mm);
  smooth(weights, us_sigma_mm);
  for (std::size_t n = 0; n < level.us.voxels.size(); ++n) level.us.voxels[n] /= std::max(weights.voxels[n], 1e-3F);
  to_local_contrast(level.us, every_block(to_float(us.lit), factor), kGrayFloor);
  smooth(level.ct, ct_sigma_mm);
  to_local_contrast(level.ct, volume::FloatGrid(level.ct.geometry, 1.0F), kHuFloor);
  return level;
}

std::vector<Vec3> sample_usable(const WorkingUltrasound& us, std::size_t count, std::uint64_t seed) {
  const volume::GridGeometry& geometry = us.usable.geometry;
  Random random(seed);
  const double share = static_cast<double>(count) / static_cast<double>(us.usable_count);
  std::vector<Vec3> points;
  points.reserve(count + count / 8);
  for (std::size_t n = 0; n < us.usable.voxels.size(); ++n) {
    if (us.usable.voxels[n] == 0 || random.uniform() >= share) continue;
    Vec3 index = volume::to_vec3(geometry.index_of(n));
    for (int a = 0; a < 3; ++a) index[a] += random.uniform() - 0.5;
    points.push_back(geometry.to_mm(index));
  }
  return points;
}

}  // namespace trocar::registration::detail
