// 3D SIFT: keypoints of a volume, descriptors, matches of large sets.

#include <fmt/format.h>

#include <algorithm>

#include "bench/benchmarks.h"
#include "core/random.h"
#include "lab/registration/volume_series.h"
#include "registration/intensity/gray_levels.h"
#include "registration/matching/match.h"
#include "registration/shadow/shadow_mask.h"

namespace trocar::bench {
namespace {

constexpr int kSiftRounds = 7;
constexpr std::size_t kMatched = 13500;  ///< The number of keypoints that the peer was measured with.

/// Set of keypoints with random descriptors of unit length, one each.
registration::KeypointSet random_set(std::uint64_t seed) {
  Random random(seed);
  registration::KeypointSet set;
  set.keypoints.resize(kMatched);
  set.gray.resize(kMatched);
  set.features.features.resize(kMatched);
  set.features.descriptors.resize(kMatched);
  for (std::size_t n = 0; n < kMatched; ++n) {
    set.features.features[n].keypoint = n;
    for (std::int16_t& v : set.features.descriptors[n]) v = static_cast<std::int16_t>(random.next() % 627);
  }
  return set;
}

void scale(Figures& figures, double factor) {
  for (auto* value : {&figures.median, &figures.p99, &figures.p999, &figures.max})
    if (*value) **value *= factor;
}

}  // namespace

Result<std::vector<CaseResult>> run_sift_benchmark() {
  registration::SeriesOptions options;
  options.volumes = 1;
  options.edge_voxels = 128;
  const volume::LabelGrid gray = registration::make_volume_series(options, 1).front().gray;
  TROCAR_TRY(const registration::Beams beams, registration::Beams::along_axis("+z", gray.geometry));
  const double mvoxels = 1e-6 * static_cast<double>(gray.geometry.voxel_count());
  std::vector<CaseResult> results;

  std::vector<registration::Keypoint> keypoints;
  registration::ScaleSpace space;
  const auto detect = [&]() -> Status {
    const volume::MaskGrid inside = registration::imaged_voxels(gray, beams);
    TROCAR_TRY(const double threshold,
               registration::estimate_shadow_threshold(std::span(&gray, 1), std::span(&inside, 1)));
    TROCAR_TRY(const registration::ImagedRegion region, registration::find_shadows(gray, beams, threshold));
    TROCAR_TRY(const volume::FloatGrid flat, registration::flatten(gray, region.usable));
    TROCAR_TRY(space, registration::build_scale_space(flat, region.usable));
    TROCAR_TRY(keypoints, registration::find_keypoints(space));
    return {};
  };
  TROCAR_TRY_STATUS(detect());
  Figures figures = time_ms(1, kSiftRounds, [&] { (void)detect(); });
  scale(figures, 1.0 / mvoxels);
  results.push_back({"sift/keypoints-per-mvoxel",
                     "ms",
                     figures,
                     {},
                     fmt::format("shadow mask, flattening, scale space and {} keypoints of 128^3", keypoints.size())});

  std::size_t descriptors = 0;
  figures = time_ms(1, kSiftRounds, [&] {
    if (const auto features = registration::describe(space, keypoints)) descriptors = features->descriptors.size();
  });
  scale(figures, 1.0 / static_cast<double>(std::max<std::size_t>(descriptors, 1)));
  results.push_back({"sift/descriptor",
                     "ms",
                     figures,
                     {},
                     fmt::format("of 2048 elements, orientation included; mean of {}", descriptors)});

  const registration::KeypointSet a = random_set(1), b = random_set(2);
  std::size_t matches = 0;
  figures = time_ms(0, 3, [&] {
    if (const auto found = registration::match(a, b, {.largest_ratio = 1.0})) matches = found->size();
  });
  const double mib = 2.0 * static_cast<double>(kMatched * sizeof(registration::Descriptor)) / (1 << 20);
  results.push_back(
      {"sift/match-13500",
       "ms",
       figures,
       {},
       fmt::format("13,500 by 13,500 descriptors, mutual: {} matches; both sets {:.0f} MiB", matches, mib)});
  return results;
}

}  // namespace trocar::bench
