#include "haptics/coupling/coupling_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace trocar::haptics {
namespace {

Status check_coupling_value(double value, double low, double high, const char* name, const char* unit) {
  constexpr double kRounding = 1e-9;  // a scale and its inverse
  if (std::isfinite(value) && value >= low * (1.0 - kRounding) && value <= high * (1.0 + kRounding)) return {};
  return fail_usage(fmt::format("{} is {:.4g} {}", name, value, unit), "the coupling of this device",
                    fmt::format("give a number from {:.4g} to {:.4g}", low, high));
}

}  // namespace

CouplingLimits limits_of(const DevicePreset& preset) noexcept {
  const double scale = preset.motion_scale * preset.force_scale;
  CouplingLimits limits;
  limits.most_n_per_mm = preset.capability.max_stiffness_n_per_mm / scale;
  if (preset.has_force()) limits.most_ns_per_mm = preset.max_damping_ns_per_mm / scale;
  limits.least_n_per_mm = std::min(limits.least_n_per_mm, limits.most_n_per_mm);
  return limits;
}

CouplingParams within(const CouplingParams& coupling, const CouplingLimits& limits) noexcept {
  CouplingParams nearest = coupling;
  nearest.stiffness_n_per_mm = std::clamp(coupling.stiffness_n_per_mm, limits.least_n_per_mm, limits.most_n_per_mm);
  nearest.damping_ns_per_mm *= std::min(1.0, nearest.stiffness_n_per_mm / coupling.stiffness_n_per_mm);
  const double most_ns_per_mm = std::min(limits.most_ns_per_mm, limits.longest_s * nearest.stiffness_n_per_mm);
  nearest.damping_ns_per_mm = std::clamp(nearest.damping_ns_per_mm, 0.0, most_ns_per_mm);
  return nearest;
}

Status check(const CouplingParams& coupling, const CouplingLimits& limits) {
  TROCAR_TRY_STATUS(check_coupling_value(coupling.stiffness_n_per_mm, limits.least_n_per_mm, limits.most_n_per_mm,
                                         "coupling.stiffness", "N/mm"));
  const double most_ns_per_mm = std::min(limits.most_ns_per_mm, limits.longest_s * coupling.stiffness_n_per_mm);
  return check_coupling_value(coupling.damping_ns_per_mm, 0.0, most_ns_per_mm, "coupling.damping", "N s/mm");
}

}  // namespace trocar::haptics
