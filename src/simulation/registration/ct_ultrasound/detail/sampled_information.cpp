#include "registration/ct_ultrasound/detail/sampled_information.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"

namespace trocar::registration::detail {
namespace {

constexpr std::size_t kBins = 32;
constexpr std::size_t kPadding = 2;  ///< Bins beside the values, for the window of the CT.
constexpr double kLargest = 3.0;     ///< Local contrast.
constexpr double kWidth = 2.0 * kLargest / static_cast<double>(kBins - 2 * kPadding);

double to_bin(double contrast) {
  return static_cast<double>(kPadding) + (std::clamp(contrast, -kLargest, kLargest) + kLargest) / kWidth;
}

/// The four bins under a sample's cubic window.
struct Window {
  std::size_t first = 0;
  std::array<double, 4> weight{}, slope{};
};

Window window_of(double contrast) {
  const double x = std::min(to_bin(contrast), static_cast<double>(kBins - kPadding) - 1e-9);
  const double cell = std::floor(x);
  const double t = x - cell, s = 1.0 - t;
  Window window;
  window.first = static_cast<std::size_t>(cell) - 1;
  window.weight = {s * s * s / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
                   (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0, t * t * t / 6.0};
  window.slope = {-0.5 * s * s, 1.5 * t * t - 2.0 * t, -1.5 * s * s + 2.0 * s, 0.5 * t * t};
  return window;
}

}  // namespace

SampledInformation::SampledInformation(std::span<const float> us) {
  us_bins_.reserve(us.size());
  for (const float contrast : us)
    us_bins_.push_back(std::min(static_cast<std::size_t>(to_bin(static_cast<double>(contrast))), kBins - 1));
}

double SampledInformation::evaluate(std::span<const double> ct, std::vector<double>& slopes) {
  TROCAR_CHECK(ct.size() == us_bins_.size());
  std::array<std::array<double, kBins>, kBins> joint{};
  const double share = 1.0 / static_cast<double>(ct.size());
  for (std::size_t n = 0; n < ct.size(); ++n) {
    const Window window = window_of(ct[n]);
    for (std::size_t b = 0; b < 4; ++b) joint[us_bins_[n]][window.first + b] += share * window.weight[b];
  }
  std::array<double, kBins> us_share{}, ct_share{};
  for (std::size_t u = 0; u < kBins; ++u)
    for (std::size_t c = 0; c < kBins; ++c) {
      us_share[u] += joint[u][c];
      ct_share[c] += joint[u][c];
    }
  double information = 0.0;
  std::array<std::array<double, kBins>, kBins> log_ratio{};
  for (std::size_t u = 0; u < kBins; ++u)
    for (std::size_t c = 0; c < kBins; ++c) {
      if (joint[u][c] <= 0.0) continue;
      log_ratio[u][c] = std::log(joint[u][c] / ct_share[c]);
      information += joint[u][c] * (log_ratio[u][c] - std::log(us_share[u]));
    }
  slopes.assign(ct.size(), 0.0);
  for (std::size_t n = 0; n < ct.size(); ++n) {
    if (std::abs(ct[n]) >= kLargest) continue;
    const Window window = window_of(ct[n]);
    for (std::size_t b = 0; b < 4; ++b)
      slopes[n] += share / kWidth * window.slope[b] * log_ratio[us_bins_[n]][window.first + b];
  }
  return information;
}

}  // namespace trocar::registration::detail
