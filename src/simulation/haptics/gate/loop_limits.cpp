#include "haptics/gate/loop_limits.h"

#include <algorithm>

namespace trocar::haptics {
namespace {

constexpr double kDelayPeriods = 1.5;    // of a wrench: held for a period, one period late (physics.md H2)
constexpr double kLongestFull_s = 0.01;  // a loop below 100 Hz is slow for any coupling [assumed]
constexpr double kLeastLate = 1.5;       // periods; a smaller delay is rounding of the grid [assumed]

}  // namespace

double permitted_share(const CouplingParams& coupling, double period_s, const GateParams& params) noexcept {
  if (!(coupling.stiffness_n_per_mm > 0.0)) return 1.0;
  const double made_ns_per_mm =
      kDelayPeriods * coupling.stiffness_n_per_mm * period_s - std::max(0.0, coupling.damping_ns_per_mm);
  if (made_ns_per_mm <= params.physical_damping_ns_per_mm) return 1.0;
  return params.physical_damping_ns_per_mm / made_ns_per_mm;
}

double longest_period_s(const CouplingParams& coupling, const GateParams& params) noexcept {
  double longest_s = kLongestFull_s;
  if (coupling.stiffness_n_per_mm > 0.0) {
    const double covered_ns_per_mm = params.physical_damping_ns_per_mm + std::max(0.0, coupling.damping_ns_per_mm);
    longest_s = std::min(longest_s, covered_ns_per_mm / (kDelayPeriods * coupling.stiffness_n_per_mm));
  }
  return std::max(longest_s, kLeastLate * params.period_s);
}

}  // namespace trocar::haptics
