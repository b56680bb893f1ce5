#include "haptics/gate/gate_params.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "haptics/gate/gate_stages.h"

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
namespace {

constexpr double kLooseHand_ns_per_mm = 0.003;  // a quarter of the hand of H1 [assumed, 0.001..0.012]
constexpr double kNeverVibrating_mw = 1e6;      // end of the gate's range
constexpr double kSoftestScale = 0.1;           // a smaller value would disable the energy account [assumed]

}  // namespace

GateParams gate_params(const stylus::DevicePreset& preset) noexcept {
  const stylus::DeviceCapability& device = preset.capability;
  GateParams params;
  params.peak_force_n = device.peak_force_n;
  params.peak_torque_nmm = device.peak_torque_nmm;
  params.continuous_force_n = stylus::continuous_force_n(preset);
  params.continuous_torque_nmm = stylus::continuous_torque_nmm(preset);
  params.peak_roll_nmm = device.peak_roll_nmm;
  params.continuous_roll_nmm = stylus::continuous_roll_nmm(preset);
  params.max_damping_ns_per_mm = preset.max_damping_ns_per_mm;
  params.brake_ns_per_mm = std::min(params.brake_ns_per_mm, params.max_damping_ns_per_mm);
  // Stiffness of the patient's springs at the device; never stiffer, which would limit more.
  params.softest_n_per_mm *= std::clamp(preset.force_scale * preset.motion_scale, kSoftestScale, 1.0);
  params.softest_nmm_per_rad *= std::clamp(preset.force_scale, kSoftestScale, 1.0);
  params.physical_damping_ns_per_mm = preset.viscosity_ns_per_mm + kLooseHand_ns_per_mm;
  if (!preset.has_force()) params.max_vibration_mw = kNeverVibrating_mw;  // a displayed force moves nothing
  params.count_mm = preset.encoder.count_mm;
  params.count_rad = preset.encoder.count_rad;
  return params;
}

namespace {

constexpr double kDelayPeriods = 1.5;    // of a wrench: held for a period, one period late (physics.md H2)
constexpr double kLongestFull_s = 0.01;  // a loop below 100 Hz is slow for any coupling [assumed]
constexpr double kLeastLate = 1.5;       // periods; a smaller delay is rounding of the grid [assumed]

}  // namespace

double permitted_share(const stylus::CouplingParams& coupling, double period_s, const GateParams& params) noexcept {
  if (!(coupling.stiffness_n_per_mm > 0.0)) return 1.0;
  const double made_ns_per_mm =
      kDelayPeriods * coupling.stiffness_n_per_mm * period_s - std::max(0.0, coupling.damping_ns_per_mm);
  if (made_ns_per_mm <= params.physical_damping_ns_per_mm) return 1.0;
  return params.physical_damping_ns_per_mm / made_ns_per_mm;
}

double longest_period_s(const stylus::CouplingParams& coupling, const GateParams& params) noexcept {
  double longest_s = kLongestFull_s;
  if (coupling.stiffness_n_per_mm > 0.0) {
    const double covered_ns_per_mm = params.physical_damping_ns_per_mm + std::max(0.0, coupling.damping_ns_per_mm);
    longest_s = std::min(longest_s, covered_ns_per_mm / (kDelayPeriods * coupling.stiffness_n_per_mm));
  }
  return std::max(longest_s, kLeastLate * params.period_s);
}

}  // namespace trocar::haptics
