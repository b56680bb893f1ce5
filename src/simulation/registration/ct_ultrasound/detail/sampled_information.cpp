#include "registration/ct_ultrasound/detail/sampled_information.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "core/result.h"

namespace trocar::registration::detail {
namespace {

constexpr std::size_t kBins = 32;
constexpr std::size_t kPadding = 2;  ///< Bins beside the values, for the window of the CT.
constexpr std::size_t kLastUsBin = kBins - kPadding - 1;
constexpr double kLargest = 3.0;  ///< Local contrast.
constexpr double kWidth = 2.0 * kLargest / static_cast<double>(kBins - 2 * kPadding);
constexpr std::size_t kHistogramPart = 4096;  ///< Samples of one histogram.

/// Rows: bins of the ultrasound.
using Joint = std::array<std::array<double, kBins>, kBins>;

double to_bin(double contrast) {
  return static_cast<double>(kPadding) + (std::clamp(contrast, -kLargest, kLargest) + kLargest) / kWidth;
}

/// Place of a sample's cubic window: four bins, and the sample's share of the way from the second to the third.
struct Window {
  std::size_t first = 0;
  double t = 0.0;
};

Window window_of(double contrast) {
  const double x = std::min(to_bin(contrast), static_cast<double>(kBins - kPadding) - 1e-9);
  const auto cell = static_cast<std::size_t>(x);
  return {cell - 1, x - static_cast<double>(cell)};
}

std::array<double, 4> weights_at(double t) {
  const double s = 1.0 - t, tt = t * t, ss = s * s;
  constexpr double kSixth = 1.0 / 6.0, kMiddle = 2.0 / 3.0;
  return {kSixth * ss * s, kMiddle - tt + 0.5 * tt * t, kMiddle - ss + 0.5 * ss * s, kSixth * tt * t};
}

/// Derivatives of the weights by t.
std::array<double, 4> slopes_at(double t) {
  const double s = 1.0 - t;
  return {-0.5 * s * s, (1.5 * t - 2.0) * t, (2.0 - 1.5 * s) * s, 0.5 * t * t};
}

/// Sums of the samples' windows, not divided by the number of samples.
Joint joint_of(std::span<const std::uint8_t> us_bins, std::span<const double> ct) {
  std::vector<Joint> parts((ct.size() + kHistogramPart - 1) / kHistogramPart);
  parallel_for(parts.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t part = first; part < last; ++part) {
      parts[part] = {};
      for (std::size_t n = part * kHistogramPart; n < std::min(ct.size(), (part + 1) * kHistogramPart); ++n) {
        if (std::isnan(ct[n])) continue;
        const Window window = window_of(ct[n]);
        double* bins = parts[part][us_bins[n]].data() + window.first;
        const std::array<double, 4> weights = weights_at(window.t);
        for (std::size_t b = 0; b < 4; ++b) bins[b] += weights[b];
      }
    }
  });
  Joint joint{};
  for (const Joint& part : parts)
    for (std::size_t u = 0; u < kBins; ++u)
      for (std::size_t c = 0; c < kBins; ++c) joint[u][c] += part[u][c];
  return joint;
}

/// Information of a joint histogram, and ln(p(u, c) / p(c)).
struct Information {
  double nats = 0.0;
  double count = 0.0;  ///< Samples.
  Joint log_ratio{};
};

Information information_of(const Joint& joint) {
  Information result;
  std::array<double, kBins> us_share{}, ct_share{};
  for (std::size_t u = 0; u < kBins; ++u)
    for (std::size_t c = 0; c < kBins; ++c) {
      us_share[u] += joint[u][c];
      ct_share[c] += joint[u][c];
      result.count += joint[u][c];
    }
  if (result.count <= 0.0) return result;
  for (std::size_t u = 0; u < kBins; ++u)
    for (std::size_t c = 0; c < kBins; ++c) {
      if (joint[u][c] <= 0.0) continue;
      result.log_ratio[u][c] = std::log(joint[u][c] / ct_share[c]);
      result.nats += joint[u][c] / result.count * (result.log_ratio[u][c] - std::log(us_share[u] / result.count));
    }
  return result;
}

}  // namespace

SampledInformation::SampledInformation(std::span<const float> us) {
  us_bins_.reserve(us.size());
  for (const float contrast : us)
    us_bins_.push_back(static_cast<std::uint8_t>(
        std::min(static_cast<std::size_t>(to_bin(static_cast<double>(contrast))), kLastUsBin)));
}

double SampledInformation::value(std::span<const double> ct) const {
  TROCAR_CHECK(ct.size() == us_bins_.size());
  return information_of(joint_of(us_bins_, ct)).nats;
}

double SampledInformation::evaluate(std::span<const double> ct, std::vector<double>& slopes) const {
  TROCAR_CHECK(ct.size() == us_bins_.size());
  const Information information = information_of(joint_of(us_bins_, ct));
  slopes.assign(ct.size(), 0.0);
  if (information.count <= 0.0) return 0.0;
  const double scale = 1.0 / (information.count * kWidth);
  parallel_for(ct.size(), kHistogramPart, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      if (!(std::abs(ct[n]) < kLargest)) continue;  // also NaN
      const Window window = window_of(ct[n]);
      const double* ratios = information.log_ratio[us_bins_[n]].data() + window.first;
      const std::array<double, 4> weight_slopes = slopes_at(window.t);
      double sum = 0.0;
      for (std::size_t b = 0; b < 4; ++b) sum += weight_slopes[b] * ratios[b];
      slopes[n] = scale * sum;
    }
  });
  return information.nats;
}

}  // namespace trocar::registration::detail
