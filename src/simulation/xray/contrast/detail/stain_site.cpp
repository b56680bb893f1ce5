#include "xray/contrast/detail/stain_site.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"

namespace trocar::xray::detail {
namespace {

constexpr std::uint64_t kCoarseSeed = 0x5741494eULL, kFineSeed = 0x464c434bULL;
constexpr double kFine = 0.45;  ///< Correlation length of the finer half of the uptake's heterogeneity, relative.
constexpr double kTractResistance = 0.55;  ///< Relative to the tissue. Assumed, range 0.3..1.
constexpr double kExactReach = 2.5;        ///< Voxels around the tip in which the straight distance is used.
constexpr double kLeastReach = 0.2;        ///< Voxels.

}  // namespace

StainSite::StainSite(const volume::GridGeometry& lattice, const Vec3& tip_P, const volume::Index3& seed,
                     const ContrastMedium& medium)
    : lattice_(lattice), tip_P_(tip_P), heterogeneity_(medium.heterogeneity), correlation_mm_(medium.correlation_mm) {
  frontier_.push_back({0.0, seed});
}

double StainSite::share(const Voxel& voxel, double front_mm) noexcept {
  return voxel.reach_mm < front_mm ? -std::expm1(-voxel.uptake * (front_mm / voxel.reach_mm - 1.0)) : 0.0;
}

double StainSite::resistance(const volume::Index3& at, bool is_tract) const {
  const double tract = is_tract ? kTractResistance : 1.0;
  if (heterogeneity_ == 0.0) return tract;
  return tract * std::exp(-0.5 * heterogeneity_ * uptake_field(lattice_.centre_mm(at), correlation_mm_, kCoarseSeed));
}

/// Upwind solution of |grad reach| = resistance from the neighbours that have a reach.
double StainSite::find_reach(const volume::Index3& at, double resistance) const {
  const double spacing_mm = lattice_.spacing_mm[0];
  const double straight_mm = (lattice_.centre_mm(at) - tip_P_).norm();
  if (straight_mm < kExactReach * spacing_mm) return resistance * std::max(straight_mm, kLeastReach * spacing_mm);
  std::array<double, 3> before{};
  for (std::size_t a = 0; a < 3; ++a) {
    before[a] = std::numeric_limits<double>::infinity();
    for (const std::int64_t side : {-1, 1}) {
      volume::Index3 next = at;
      next[a] += side;
      if (!lattice_.contains(next)) continue;
      const auto found = reach_mm_.find(lattice_.offset(next));
      if (found != reach_mm_.end()) before[a] = std::min(before[a], found->second);
    }
  }
  std::sort(before.begin(), before.end());
  const double step_mm = resistance * spacing_mm;
  double reach = before[0] + step_mm, sum = before[0], squares = before[0] * before[0];
  for (std::size_t n = 1; n < 3 && before[n] < reach; ++n) {
    sum += before[n];
    squares += before[n] * before[n];
    const double count = static_cast<double>(n) + 1.0;
    const double root = sum * sum - count * (squares - step_mm * step_mm);
    if (root < 0.0) break;
    reach = (sum + std::sqrt(root)) / count;
  }
  return reach;
}

bool StainSite::expand(const CanEnter& can_enter, const IsTract& is_tract) {
  while (!frontier_.empty()) {
    std::pop_heap(frontier_.begin(), frontier_.end(), std::greater<>());
    const Waiting next = frontier_.back();
    frontier_.pop_back();
    if (!reach_mm_.emplace(lattice_.offset(next.at), next.reach_mm).second) continue;
    Voxel voxel{next.at, std::max(next.reach_mm, kLeastReach * lattice_.spacing_mm[0]), 1.0};
    if (heterogeneity_ > 0.0) {
      const Vec3 p_P = lattice_.centre_mm(next.at);
      voxel.uptake = std::exp(heterogeneity_ * (0.7 * uptake_field(p_P, correlation_mm_, kCoarseSeed) +
                                                0.7 * uptake_field(p_P, kFine * correlation_mm_, kFineSeed)));
    }
    voxels_.push_back(voxel);
    for (const volume::Index3& step : kNeighbours) {
      const volume::Index3 to{next.at[0] + step[0], next.at[1] + step[1], next.at[2] + step[2]};
      if (!lattice_.contains(to) || reach_mm_.contains(lattice_.offset(to)) || !can_enter(to)) continue;
      const auto [known, is_new] = resistance_.try_emplace(lattice_.offset(to), 0.0);
      if (is_new) known->second = resistance(to, is_tract(to));
      frontier_.push_back({std::max(find_reach(to, known->second), next.reach_mm), to});
      std::push_heap(frontier_.begin(), frontier_.end(), std::greater<>());
    }
    return true;
  }
  return false;
}

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
