#include "registration/matching/match.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/parallel.h"
#include "registration/matching/detail/nearest.h"

namespace trocar::registration {
namespace {

Status check(const MatchOptions& options) {
  if (!(options.largest_ratio >= 0.1 && options.largest_ratio <= 1.0))
    return fail_usage("the largest ratio of distances is out of range", fmt::format("{:g}", options.largest_ratio),
                      "give 0.1 to 1");
  if (!(options.largest_gray_distance >= 0.0 && options.largest_gray_distance <= 1.0))
    return fail_usage("the largest distance of gray levels is out of range",
                      fmt::format("{:g}", options.largest_gray_distance), "give 0 to 1");
  return {};
}

std::vector<std::uint32_t> owners_of(const Features& features) {
  std::vector<std::uint32_t> owners;
  owners.reserve(features.features.size());
  for (const Feature& feature : features.features) owners.push_back(static_cast<std::uint32_t>(feature.keypoint));
  return owners;
}

/// Of two descriptors of the same length, from their product.
double distance_of(std::int32_t product) {
  const double squared = static_cast<double>(kDescriptorNorm) * kDescriptorNorm;
  return std::sqrt(std::max(0.0, 2.0 - 2.0 * static_cast<double>(product) / squared));
}

}  // namespace

Result<std::vector<Match>> match(const KeypointSet& a, const KeypointSet& b, const MatchOptions& options) {
  TROCAR_TRY_STATUS(check(options));
  const auto owners_a = owners_of(a.features), owners_b = owners_of(b.features);
  const detail::NearestOfBoth nearest =
      detail::find_nearest(a.features.descriptors, owners_a, b.features.descriptors, owners_b);
  std::vector<Match> matches;
  for (std::size_t n = 0; n < owners_a.size(); ++n) {
    const detail::Nearest& found = nearest.of_a[n];
    if (found.product < 0 || found.second < 0) continue;
    Match m;
    m.a = owners_a[n];
    m.b = found.owner;
    m.feature_a = static_cast<std::uint32_t>(n);
    m.feature_b = found.index;
    m.distance = distance_of(found.product);
    const double second = distance_of(found.second);
    m.ratio = second > 0.0 ? m.distance / second : 1.0;
    if (m.ratio > options.largest_ratio) continue;
    if (options.is_mutual && nearest.of_b[found.index].owner != m.a) continue;
    m.gray_distance = histogram_distance(a.gray[m.a], b.gray[m.b]);
    if (m.gray_distance > options.largest_gray_distance) continue;
    matches.push_back(m);
  }
  std::stable_sort(matches.begin(), matches.end(), [](const Match& x, const Match& y) { return x.ratio < y.ratio; });
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  std::erase_if(matches, [&](const Match& m) { return !pairs.insert({m.a, m.b}).second; });
  return matches;
}

namespace {

constexpr std::int64_t kEdge = 8;  ///< Voxels.

/// Share of the usable voxels darker than each gray level, half of those of the level included, in bins.
std::array<float, 256> rank_bins(const volume::LabelGrid& gray, const volume::MaskGrid& usable) {
  std::array<double, 256> counts{};
  double total = 0.0;
  for (std::size_t n = 0; n < gray.voxels.size(); ++n) {
    if (usable.voxels[n] == 0) continue;
    counts[gray.voxels[n]] += 1.0;
    total += 1.0;
  }
  std::array<float, 256> bins{};
  double below = 0.0;
  for (std::size_t g = 0; g < counts.size(); ++g) {
    bins[g] = total > 0.0 ? static_cast<float>(kGrayBins * (below + 0.5 * counts[g]) / total) : 0.0F;
    below += counts[g];
  }
  return bins;
}

}  // namespace

std::vector<GrayHistogram> gray_histograms(const volume::LabelGrid& gray, const volume::MaskGrid& usable,
                                           const std::vector<Keypoint>& keypoints) {
  const std::array<float, 256> bins = rank_bins(gray, usable);
  const auto& geometry = gray.geometry;
  std::vector<GrayHistogram> histograms(keypoints.size());
  parallel_for(keypoints.size(), 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      GrayHistogram& histogram = histograms[n];
      histogram.fill(0.0F);
      const Vec3 centre = geometry.to_index(keypoints[n].p_P);
      volume::Index3 begin, end;
      for (std::size_t a = 0; a < 3; ++a) {
        const auto low = static_cast<std::int64_t>(std::ceil(centre[static_cast<Eigen::Index>(a)] - kEdge / 2));
        begin[a] = std::max<std::int64_t>(0, low);
        end[a] = std::min(geometry.size[a], low + kEdge);
      }
      float total = 0.0F;
      for (std::int64_t k = begin[2]; k < end[2]; ++k) {
        for (std::int64_t j = begin[1]; j < end[1]; ++j) {
          for (std::int64_t i = begin[0]; i < end[0]; ++i) {
            const std::size_t at = geometry.offset({i, j, k});
            if (usable.voxels[at] == 0) continue;
            const int bin = std::clamp(static_cast<int>(bins[gray.voxels[at]]), 0, kGrayBins - 1);
            histogram[static_cast<std::size_t>(bin)] += 1.0F;
            total += 1.0F;
          }
        }
      }
      if (total > 0.0F)
        for (float& share : histogram) share /= total;
    }
  });
  return histograms;
}

double histogram_distance(const GrayHistogram& a, const GrayHistogram& b) noexcept {
  constexpr std::size_t kTogether = 4;
  double sum = 0.0;
  for (std::size_t first = 0; first < a.size(); first += kTogether) {
    double difference = 0.0;
    for (std::size_t n = first; n < first + kTogether; ++n)
      difference += static_cast<double>(a[n]) - static_cast<double>(b[n]);
    sum += std::abs(difference);
  }
  return 0.5 * sum;
}

}  // namespace trocar::registration
