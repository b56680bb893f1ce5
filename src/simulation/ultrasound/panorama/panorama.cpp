#include "ultrasound/panorama/panorama.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/live/live_schedule.h"
#include "core/log.h"
#include "core/parallel.h"
#include "ultrasound/panorama/detail/panorama_sampler.h"
#include "volume/distance.h"

namespace trocar::ultrasound {
namespace {

constexpr int kLevels = 255;

/// Level (dB) of a gray value: the middle of those that the scanner shows with it.
double level_of_gray(std::uint8_t gray, const DisplaySettings& settings, double floor_db) {
  const auto first_with = [&](int least) {
    double low = floor_db, high = kWhite_db;
    for (int n = 0; n < 32; ++n) {
      const double middle = 0.5 * (low + high);
      (gray_of_level(middle, settings) >= least ? high : low) = middle;
    }
    return high;
  };
  return 0.5 * (first_with(gray) + (gray == 255 ? kWhite_db : first_with(gray + 1)));
}

std::array<std::uint8_t, 256> make_levels(const PanoramaOptions& options, const Panorama& panorama) {
  DisplaySettings settings;
  settings.dynamic_range_db = options.dynamic_range_db;
  settings.gray_map = options.gray_map;
  std::array<std::uint8_t, 256> levels{};
  for (int gray = 1; gray < 256; ++gray) {
    const double above_db =
        level_of_gray(static_cast<std::uint8_t>(gray), settings, panorama.floor_db) - panorama.floor_db;
    levels[static_cast<std::size_t>(gray)] = static_cast<std::uint8_t>(
        std::clamp(1 + static_cast<int>(std::lround(above_db / panorama.step_db)), 1, kLevels));
  }
  return levels;
}

/// Median level of the voxels that are not black.
double find_tissue_db(const Panorama& panorama) {
  constexpr double kBlack = 0.25;  // of the dynamic range (assumed)
  constexpr double kLowest_db = -30.0;
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t level : panorama.levels) ++counts[level];
  const auto first = static_cast<std::size_t>(kBlack * kLevels);
  const std::size_t all =
      std::accumulate(counts.begin() + static_cast<std::ptrdiff_t>(first), counts.end(), std::size_t{0});
  std::size_t sum = 0, median = first;
  while (median < kLevels && 2 * (sum += counts[median]) < all) ++median;
  return all == 0 ? 0.0 : std::max(panorama.level_db(static_cast<std::uint8_t>(median)), kLowest_db);
}

/// Weights by the distance to the nearest voxel that was never imaged or lies outside the grid.
std::vector<std::uint8_t> make_weights(const volume::LabelGrid& gray, double fade_mm) {
  volume::GridGeometry wide = gray.geometry;
  for (std::size_t a = 0; a < 3; ++a) wide.size[a] += 2;
  volume::MaskGrid unknown(wide, 1);
  const auto row = static_cast<std::size_t>(gray.geometry.size[0]);
  const auto rows_of = [&](std::size_t n, const auto& take) {
    const volume::Index3 ijk = gray.geometry.index_of(n * row);
    take(gray.voxels.data() + n * row, wide.offset({1, ijk[1] + 1, ijk[2] + 1}), n * row);
  };
  const std::size_t rows = gray.voxels.size() / row;
  parallel_for(rows, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      rows_of(n, [&](const std::uint8_t* from, std::size_t to, std::size_t) {
        for (std::size_t i = 0; i < row; ++i) unknown.voxels[to + i] = from[i] == 0 ? 1 : 0;
      });
  });
  const volume::FloatGrid distance_mm = volume::distance_to_mask_mm(unknown);
  std::vector<std::uint8_t> weights(gray.voxels.size() + detail::kReadBeyond, 0);
  // Samples within this distance of an unknown voxel may interpolate with it.
  const auto none_mm = static_cast<float>(detail::kWeightStep_mm + gray.geometry.spacing_mm.norm());
  parallel_for(rows, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      rows_of(n, [&](const std::uint8_t*, std::size_t from, std::size_t to) {
        for (std::size_t i = 0; i < row; ++i) {
          const float x =
              std::clamp((distance_mm.voxels[from + i] - none_mm) / static_cast<float>(fade_mm), 0.0F, 1.0F);
          weights[to + i] = static_cast<std::uint8_t>(std::lround(255.0F * x * x * (3.0F - 2.0F * x)));
        }
      });
  });
  return weights;
}

Status check(const volume::LabelGrid& gray, const PanoramaOptions& options) {
  if (!(options.dynamic_range_db >= 20.0 && options.dynamic_range_db <= 100.0))
    return fail(fmt::format("a panorama's dynamic range of {} dB is not within 20..100", options.dynamic_range_db), {},
                "correct trocar_dynamic_range_db in its header");
  if (!(options.fade_mm >= 1.0 && options.fade_mm <= 30.0))
    return fail_usage(fmt::format("a fade of {} mm is not within 1..30", options.fade_mm), {}, "choose 1 to 30");
  if (gray.voxels.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) - detail::kReadBeyond)
    return fail("the panorama has more than 2^31 voxels", {}, "stitch it with a larger spacing");
  if (std::all_of(gray.geometry.size.begin(), gray.geometry.size.end(), [](std::int64_t n) { return n >= 2; }) &&
      std::any_of(gray.voxels.begin(), gray.voxels.end(), [](std::uint8_t value) { return value != 0; }))
    return {};
  return fail("the panorama contains no imaged voxel", {}, "stitch it again: trocar ultrasound stitch");
}

}  // namespace

Result<std::shared_ptr<const Panorama>> make_panorama(const volume::LabelGrid& gray_U, const Pose& X_PU,
                                                      const PanoramaOptions& options) {
  TROCAR_TRY_STATUS(check(gray_U, options));
  auto panorama = std::make_shared<Panorama>();
  panorama->geometry = gray_U.geometry;
  panorama->X_PU = X_PU;
  panorama->floor_db = kWhite_db - options.dynamic_range_db;
  panorama->step_db = options.dynamic_range_db / (kLevels - 1);
  const auto levels = make_levels(options, *panorama);
  panorama->levels.assign(gray_U.voxels.size() + detail::kReadBeyond, 0);
  std::transform(gray_U.voxels.begin(), gray_U.voxels.end(), panorama->levels.begin(),
                 [&](std::uint8_t gray) { return levels[gray]; });
  panorama->tissue_db = find_tissue_db(*panorama);
  panorama->weights = make_weights(gray_U, options.fade_mm);
  return panorama;
}

namespace {

constexpr int kPanoramaNiceness = 5;  // as the live scanner's thread

/// On one thread of low priority: haptic servers and the window run at the same time.
Result<std::shared_ptr<const Panorama>> load_beside_attempt(const PanoramaOnDemand::Load& load) {
  lower_priority(kPanoramaNiceness);
  Result<std::shared_ptr<const Panorama>> panorama = nullptr;
  run_on_threads(1, [&] { panorama = load(); });
  return panorama;
}

}  // namespace

std::shared_ptr<const Panorama> PanoramaOnDemand::poll() {
  if (!is_possible_ || panorama_) return panorama_;
  if (!job_.has_work()) {
    job_ = BackgroundJob<std::shared_ptr<const Panorama>>(
        [load = load_](const Progress&, const std::stop_token&) { return load_beside_attempt(load); });
  }
  auto made = job_.take();
  if (!made) return nullptr;
  job_ = {};
  if (*made) {
    panorama_ = **std::move(made);
  } else {
    log_warning("no panorama: {}", made->error().text());
    is_possible_ = false;
  }
  return panorama_;
}

}  // namespace trocar::ultrasound
