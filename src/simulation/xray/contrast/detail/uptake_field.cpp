#include "xray/contrast/detail/uptake_field.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace trocar::xray::detail {
namespace {

constexpr double kMeanSquare = 0.55;      ///< Of a quadratic B-spline's samples at distance 1: 11/20.
constexpr std::uint64_t kIndexBits = 21;  ///< Of a lattice index in a counter.

/// Weights of the three coefficients nearest to a place, of which the first has the index `first`.
std::array<double, 3> weights_at(double x, std::int64_t& first) noexcept {
  const double middle = std::floor(x + 0.5);
  first = static_cast<std::int64_t>(middle) - 1;
  const double t = x - middle;
  return {0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)};
}

std::uint64_t bits_of(std::int64_t index) noexcept {
  return static_cast<std::uint64_t>(index) & ((std::uint64_t{1} << kIndexBits) - 1);
}

}  // namespace

double uptake_field(const Vec3& p_P, double correlation_mm, std::uint64_t seed) noexcept {
  std::array<std::int64_t, 3> first{};
  std::array<std::array<double, 3>, 3> weights{};
  for (std::size_t a = 0; a < 3; ++a)
    weights[a] = weights_at(p_P[static_cast<Eigen::Index>(a)] / correlation_mm, first[a]);
  double sum = 0.0;
  for (std::int64_t k = 0; k < 3; ++k)
    for (std::int64_t j = 0; j < 3; ++j)
      for (std::int64_t i = 0; i < 3; ++i) {
        const std::uint64_t counter =
            bits_of(first[0] + i) | bits_of(first[1] + j) << kIndexBits | bits_of(first[2] + k) << (2 * kIndexBits);
        const double weight = weights[0][static_cast<std::size_t>(i)] * weights[1][static_cast<std::size_t>(j)] *
                              weights[2][static_cast<std::size_t>(k)];
        sum += weight * (2.0 * uniform01(seed, counter) - 1.0);
      }
  // A uniform number of -1..1 has the variance 1/3.
  return sum * std::numbers::sqrt3 / std::pow(kMeanSquare, 1.5);
}

}  // namespace trocar::xray::detail
