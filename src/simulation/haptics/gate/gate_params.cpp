#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "haptics/gate/detail/gate_stages.h"

namespace trocar::haptics {
namespace {

/// Range of a field, and its replacement if it is out of range: the end with the least force.
struct FieldRange {
  const char* name;
  double GateParams::*field;
  double low;
  double high;
  double careful;
};

constexpr std::array<FieldRange, 35> kRanges{{
    {"peak_force_n", &GateParams::peak_force_n, 0.1, 200.0, 0.0},
    {"peak_torque_nmm", &GateParams::peak_torque_nmm, 0.0, 5000.0, 0.0},
    {"continuous_force_n", &GateParams::continuous_force_n, 0.05, 200.0, 0.0},
    {"continuous_torque_nmm", &GateParams::continuous_torque_nmm, 0.0, 5000.0, 0.0},
    {"peak_roll_nmm", &GateParams::peak_roll_nmm, 0.0, 5000.0, 1e-3},
    {"continuous_roll_nmm", &GateParams::continuous_roll_nmm, 0.0, 5000.0, 0.0},
    {"thermal_time_s", &GateParams::thermal_time_s, 0.5, 600.0, 0.5},
    {"max_damping_ns_per_mm", &GateParams::max_damping_ns_per_mm, 0.0, 0.1, 0.0},
    {"passivity_margin_mj", &GateParams::passivity_margin_mj, 0.0, 50.0, 0.0},
    {"softest_n_per_mm", &GateParams::softest_n_per_mm, 0.01, 5.0, 5.0},
    {"softest_nmm_per_rad", &GateParams::softest_nmm_per_rad, 5.0, 1e4, 1e4},
    {"count_mm", &GateParams::count_mm, 0.0, 1.0, 0.0},
    {"count_rad", &GateParams::count_rad, 0.0, 0.1, 0.0},
    {"slew_n_per_s", &GateParams::slew_n_per_s, 50.0, 1e5, 50.0},
    {"slew_nmm_per_s", &GateParams::slew_nmm_per_s, 1e3, 2e6, 1e3},
    {"stale_s", &GateParams::stale_s, 0.02, 5.0, 0.02},
    {"fade_s", &GateParams::fade_s, 0.01, 5.0, 0.2},
    {"rise_s", &GateParams::rise_s, 0.02, 10.0, 10.0},
    {"small_force_n", &GateParams::small_force_n, 0.01, 5.0, 0.01},
    {"small_torque_nmm", &GateParams::small_torque_nmm, 0.1, 200.0, 0.1},
    {"fault_ramp_s", &GateParams::fault_ramp_s, 0.001, 0.5, 0.02},
    {"brake_mm_per_s", &GateParams::brake_mm_per_s, 100.0, 5000.0, 100.0},
    {"brake_ns_per_mm", &GateParams::brake_ns_per_mm, 0.0, 0.1, 0.0},
    {"max_runaway_s", &GateParams::max_runaway_s, 0.001, 1.0, 0.001},
    {"max_unread_s", &GateParams::max_unread_s, 0.002, 1.0, 0.002},
    {"period_s", &GateParams::period_s, 1e-4, 0.01, 1e-4},
    {"physical_damping_ns_per_mm", &GateParams::physical_damping_ns_per_mm, 1e-4, 0.05, 1e-4},
    {"max_slow_s", &GateParams::max_slow_s, 0.01, 5.0, 0.01},
    {"jump_mm", &GateParams::jump_mm, 1.0, 100.0, 1.0},
    {"kick_mm", &GateParams::kick_mm, 0.5, 50.0, 0.5},
    {"thrust_mm_per_s2", &GateParams::thrust_mm_per_s2, 1e4, 1e8, 1e4},
    {"hand_mm_per_s", &GateParams::hand_mm_per_s, 1000.0, 1e4, 1000.0},
    {"turn_rad", &GateParams::turn_rad, 0.2, 3.0, 0.2},
    {"hand_rad_per_s", &GateParams::hand_rad_per_s, 10.0, 500.0, 10.0},
    {"max_vibration_mw", &GateParams::max_vibration_mw, 1.0, 1e6, 1.0},
}};
static_assert(sizeof(GateParams) == kRanges.size() * sizeof(double), "every field of GateParams has a range");

bool is_inside(double value, const FieldRange& range) noexcept {
  return value >= range.low && value <= range.high;  // false for NaN
}

}  // namespace

Status check(const GateParams& params) {
  constexpr const char* kWhere = "safety gate";
  for (const FieldRange& range : kRanges) {
    if (is_inside(params.*range.field, range)) continue;
    return fail(fmt::format("{} is {}", range.name, params.*range.field), kWhere,
                fmt::format("give a number from {} to {}", range.low, range.high));
  }
  if (params.peak_roll_nmm > 0.0 && params.continuous_roll_nmm > params.peak_roll_nmm)
    return fail("a continuous limit is above its peak", kWhere, "give the device's continuous roll torque");
  if (params.continuous_force_n > params.peak_force_n || params.continuous_torque_nmm > params.peak_torque_nmm) {
    if (params.peak_torque_nmm > 0.0 || params.continuous_force_n > params.peak_force_n)
      return fail("a continuous limit is above its peak", kWhere, "give the device's continuous force and torque");
  }
  return {};
}

namespace detail {

GateParams made_safe(const GateParams& params) noexcept {
  GateParams safe = params;
  for (const FieldRange& range : kRanges) {
    if (!is_inside(params.*range.field, range)) safe.*range.field = range.careful;
  }
  safe.continuous_force_n = std::min(safe.continuous_force_n, safe.peak_force_n);
  safe.continuous_torque_nmm = std::min(safe.continuous_torque_nmm, safe.peak_torque_nmm);
  safe.continuous_roll_nmm = std::min(safe.continuous_roll_nmm, safe.peak_roll_nmm);
  safe.brake_ns_per_mm = std::min(safe.brake_ns_per_mm, safe.max_damping_ns_per_mm);
  return safe;
}

}  // namespace detail
}  // namespace trocar::haptics
