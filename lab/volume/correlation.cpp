#include "lab/volume/correlation.h"

#include <cmath>
#include <cstddef>

#include "core/result.h"

namespace trocar::volume {

double correlation(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, ComparedVoxels voxels) {
  TROCAR_CHECK(a.size() == b.size());
  // Integers: exact for 2^48 voxels.
  std::uint64_t count = 0, sum_a = 0, sum_b = 0, sum_aa = 0, sum_bb = 0, sum_ab = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    if (voxels == ComparedVoxels::kBothAboveZero && (a[n] == 0 || b[n] == 0)) continue;
    const std::uint64_t value_a = a[n], value_b = b[n];
    ++count;
    sum_a += value_a;
    sum_b += value_b;
    sum_aa += value_a * value_a;
    sum_bb += value_b * value_b;
    sum_ab += value_a * value_b;
  }
  if (count == 0) return 0.0;
  const auto n = static_cast<double>(count);
  const double mean_a = static_cast<double>(sum_a) / n, mean_b = static_cast<double>(sum_b) / n;
  const double variance_a = static_cast<double>(sum_aa) / n - mean_a * mean_a;
  const double variance_b = static_cast<double>(sum_bb) / n - mean_b * mean_b;
  if (variance_a <= 0.0 || variance_b <= 0.0) return 0.0;
  return (static_cast<double>(sum_ab) / n - mean_a * mean_b) / std::sqrt(variance_a * variance_b);
}

}  // namespace trocar::volume
