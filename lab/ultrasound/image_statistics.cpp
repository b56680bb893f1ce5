#include "lab/ultrasound/image_statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace trocar::ultrasound {
namespace {

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
  double mean_square = 0.0;
};

Moments moments_of(std::span<const float> values) {
  Moments moments;
  if (values.empty()) return moments;
  const auto n = static_cast<double>(values.size());
  for (const float value : values) {
    moments.mean += value;
    moments.mean_square += static_cast<double>(value) * value;
  }
  moments.mean /= n;
  moments.mean_square /= n;
  moments.variance = std::max(0.0, moments.mean_square - moments.mean * moments.mean);
  return moments;
}

/// Shares of `values` in equal bins of [low, high].
std::vector<double> histogram_of(std::span<const float> values, float low, float high, std::size_t bins) {
  std::vector<double> shares(bins, 0.0);
  const double scale = static_cast<double>(bins) / std::max(1e-30, static_cast<double>(high - low));
  for (const float value : values) {
    const double place = std::clamp((value - low) * scale, 0.0, static_cast<double>(bins) - 1.0);
    shares[static_cast<std::size_t>(place)] += 1.0 / static_cast<double>(values.size());
  }
  return shares;
}

}  // namespace

TargetVisibility target_visibility(std::span<const float> inside, std::span<const float> outside) {
  TargetVisibility result;
  if (inside.empty() || outside.empty()) return result;
  const Moments in = moments_of(inside);
  const Moments out = moments_of(outside);
  constexpr double kFloor = 1e-30;  // Keeps an empty (all zero) region's level finite.
  result.contrast_db = 10.0 * std::log10((in.mean_square + kFloor) / (out.mean_square + kFloor));
  result.cnr = std::abs(in.mean - out.mean) / std::sqrt(std::max(kFloor, in.variance + out.variance));

  const auto [in_low, in_high] = std::minmax_element(inside.begin(), inside.end());
  const auto [out_low, out_high] = std::minmax_element(outside.begin(), outside.end());
  constexpr std::size_t kBins = 100;
  const float low = std::min(*in_low, *out_low);
  const float high = std::max(*in_high, *out_high);
  const auto in_shares = histogram_of(inside, low, high, kBins);
  const auto out_shares = histogram_of(outside, low, high, kBins);
  double overlap = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) overlap += std::min(in_shares[bin], out_shares[bin]);
  result.gcnr = 1.0 - overlap;
  return result;
}

GrayHistogram gray_histogram(std::span<const std::uint8_t> grays) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t gray : grays) ++counts[gray];
  GrayHistogram histogram{};
  if (grays.empty()) return histogram;
  for (std::size_t gray = 0; gray < histogram.size(); ++gray)
    histogram[gray] = static_cast<double>(counts[gray]) / static_cast<double>(grays.size());
  return histogram;
}

double earth_mover_distance(const GrayHistogram& a, const GrayHistogram& b) noexcept {
  double difference = 0.0;
  double distance = 0.0;
  for (std::size_t gray = 0; gray < a.size(); ++gray) {
    difference += a[gray] - b[gray];
    distance += std::abs(difference);
  }
  return distance;
}

double bhattacharyya_distance(const GrayHistogram& a, const GrayHistogram& b) noexcept {
  double coefficient = 0.0;
  for (std::size_t gray = 0; gray < a.size(); ++gray) coefficient += std::sqrt(a[gray] * b[gray]);
  return -std::log(coefficient);
}

int gray_percentile(const GrayHistogram& histogram, double share) noexcept {
  constexpr double kRounding = 1e-12;
  double sum = 0.0;
  for (std::size_t gray = 0; gray < histogram.size(); ++gray) {
    sum += histogram[gray];
    if (sum >= share - kRounding) return static_cast<int>(gray);
  }
  return 255;
}

double mean_gray(const GrayHistogram& histogram) noexcept {
  double mean = 0.0;
  for (std::size_t gray = 0; gray < histogram.size(); ++gray) mean += static_cast<double>(gray) * histogram[gray];
  return mean;
}

}  // namespace trocar::ultrasound
