#include "xray/detector/detector.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"
#include "core/result.h"

namespace trocar::xray {
namespace {

constexpr double kRate_hz = 30.0;  ///< Of DetectorParams::lag_share.

}  // namespace

void Lag::apply(double share, double elapsed_s, std::span<float> signal) {
  const double left = std::pow(std::clamp(share, 0.0, 0.99), kRate_hz * std::max(elapsed_s, 0.0));
  if (former_.size() == signal.size()) {
    const auto kept = static_cast<float>(share > 0.0 ? left : 0.0);
    for (std::size_t n = 0; n < signal.size(); ++n) signal[n] += kept * (former_[n] - signal[n]);
  }
  former_.assign(signal.begin(), signal.end());
}

namespace {

constexpr int kNodeBits = 12;
constexpr std::uint32_t kNodes = 1U << kNodeBits;

double normal_distribution(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

/// Inverse of the normal distribution, by bisection.
double normal_quantile(double share) {
  double low = -9.0, high = 9.0;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    (normal_distribution(middle) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Quantiles of the normal distribution at k / kNodes; a number between two of them is interpolated, so that the
/// distribution is continuous. The outermost ones are those of a tail's mean, and all are scaled to variance 1.
class QuantileTable {
 public:
  QuantileTable() {
    std::array<double, kNodes + 1> node{};
    for (std::uint32_t k = 1; k < kNodes; ++k) node[k] = normal_quantile(static_cast<double>(k) / kNodes);
    node[0] = 2.0 * normal_quantile(0.3 / kNodes) - node[1];
    node[kNodes] = -node[0];
    double variance = 0.0;  // of a linear piece between a and b: (a² + ab + b²) / 3
    for (std::uint32_t k = 0; k < kNodes; ++k)
      variance += (node[k] * node[k] + node[k] * node[k + 1] + node[k + 1] * node[k + 1]) / (3.0 * kNodes);
    for (std::uint32_t k = 0; k <= kNodes; ++k) node_[k] = static_cast<float>(node[k] / std::sqrt(variance));
  }
  float operator()(std::uint32_t random) const noexcept {
    const std::uint32_t k = random >> (32 - kNodeBits);
    constexpr float kStep = 1.0F / static_cast<float>(1U << (32 - kNodeBits));
    const float share = static_cast<float>(random & ((1U << (32 - kNodeBits)) - 1)) * kStep;
    return node_[k] + share * (node_[k + 1] - node_[k]);
  }

 private:
  std::array<float, kNodes + 1> node_{};
};

}  // namespace

void add_quantum_noise(const PhotonCount& photons, std::uint64_t seed, std::span<float> signal) {
  TROCAR_CHECK(photons.open_beam > 0.0 && photons.noise_factor >= 0.0);
  static const QuantileTable normal;
  const auto variance = static_cast<float>(photons.noise_factor / photons.open_beam);
  const std::uint64_t key = mix64(seed);
  // Two pixels share 64 random bits.
  parallel_for((signal.size() + 1) / 2, 8192, [&](std::size_t first, std::size_t last) {
    for (std::size_t pair = first; pair < last; ++pair) {
      const std::uint64_t bits = mix64(key ^ pair);
      for (std::size_t n = 2 * pair; n < std::min(2 * pair + 2, signal.size()); ++n) {
        const auto random = static_cast<std::uint32_t>(n % 2 == 0 ? bits : bits >> 32);
        const float clean = std::max(signal[n], 0.0F);
        signal[n] = std::max(0.0F, clean + std::sqrt(variance * clean) * normal(random));
      }
    }
  });
}

}  // namespace trocar::xray
