#include "anatomy/tissue/hu_transfer.h"

namespace trocar::anatomy {
namespace {

HuLaw mix(const HuLaw& a, const HuLaw& b, double t) noexcept {
  const auto lerp = [t](double x, double y) { return x + t * (y - x); };
  return {lerp(a.stiffness_n_per_mm, b.stiffness_n_per_mm),
          lerp(a.normal_n, b.normal_n),
          lerp(a.tangential_n, b.tangential_n),
          lerp(a.resistance_n, b.resistance_n),
          lerp(a.viscosity_ns_per_mm, b.viscosity_ns_per_mm),
          lerp(a.shaft_n_per_mm, b.shaft_n_per_mm),
          lerp(a.shaft_viscosity_ns_per_mm, b.shaft_viscosity_ns_per_mm),
          lerp(a.young_kpa, b.young_kpa)};
}

}  // namespace

HuLaw HuTransfer::at(double hu_value) const noexcept {
  if (knot_count == 0) return {};
  if (!(hu_value > hu[0])) return laws[0];
  for (std::size_t i = 1; i < knot_count; ++i) {
    if (hu_value < hu[i]) return mix(laws[i - 1], laws[i], (hu_value - hu[i - 1]) / (hu[i] - hu[i - 1]));
  }
  return laws[knot_count - 1];
}

}  // namespace trocar::anatomy
