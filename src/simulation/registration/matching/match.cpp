#include "registration/matching/match.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

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

}  // namespace trocar::registration
