#include "motion/motion_clock.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trocar::motion {

Status check(const MotionDrive& drive) {
  constexpr double kShortest_s = 1.0, kLongest_s = 60.0, kMostTime_s = 1e9;
  const bool has_depth = std::ranges::all_of(drive.depth, [](double d) { return std::abs(d) <= kMostDrive; });
  if (!(drive.period_s >= kShortest_s && drive.period_s <= kLongest_s) || !(std::abs(drive.begins_s) <= kMostTime_s) ||
      !(drive.held_phase >= 0.0 && drive.held_phase <= 1.0) || !has_depth)
    return fail("a number is out of its range", "motion of the patient",
                "use a period of 1 to 60 s, a phase of 0 to 1 and depths of at most 1.5");
  return {};
}

double phase_at(const MotionDrive& drive, double time_s) noexcept {
  if (drive.is_held) return drive.held_phase;
  const double breaths = (time_s - drive.begins_s) / drive.period_s;
  return breaths - std::floor(breaths);
}

MotionState state_of_phase(const MotionDrive& drive, double phase, double time_s) noexcept {
  MotionState state;
  state.time_s = time_s;
  state.phase = phase;
  const double angle = 2.0 * std::numbers::pi * phase;
  const double share = 0.5 * (1.0 - std::cos(angle));
  const double share_per_s = drive.is_held ? 0.0 : std::numbers::pi / drive.period_s * std::sin(angle);
  for (std::size_t i = 0; i < kMostDrivers; ++i) {
    state.drivers[i] = drive.depth[i] * share;
    state.rates_per_s[i] = drive.depth[i] * share_per_s;
  }
  return state;
}

}  // namespace trocar::motion
