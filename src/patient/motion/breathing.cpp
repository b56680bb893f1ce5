#include "motion/breathing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace trocar::motion {
namespace {

constexpr double kInspirationShare = 0.4;
constexpr double kChestLead = 0.25;  ///< The chest is so much of phase * (1 - phase) ahead of the diaphragm.
constexpr double kFastestReaction_s = 0.4, kSlowestReaction_s = 1.0;
constexpr double kResumes_s = 0.3;  ///< From "breathe again" to the breath.
constexpr double kDriftFades_s = 1.0;
constexpr double kDeeperAfterHold = 1.3;

/// What a number is drawn for.
enum class Draw : std::uint64_t { kBegin = 1, kDepth, kPause, kReaction, kCough };

/// Uniform in -1..1: a function of seed, kind and number alone.
double draw(std::uint32_t of, Draw kind, std::int64_t number) noexcept {
  const std::uint64_t seed = std::uint64_t{of} << 8 | static_cast<std::uint64_t>(kind);
  return 2.0 * uniform01(seed, static_cast<std::uint64_t>(number)) - 1.0;
}

/// One breath: begins at end-expiration, rests there before the next one.
struct Breath {
  double begins_s, moves_s, ends_s;  ///< Moves for moves_s of the time to ends_s.
  double depth;                      ///< In depths of a regular breath.
  bool coughs;                       ///< At its end.
};

/// Breaths from a time on: at once, or after a hold.
struct Series {
  std::uint32_t seed;
  double first_depth;
};

double breath_begins_s(const MotionDrive& drive, const Series& series, std::int64_t number) noexcept {
  const double shift = number == 0 ? 0.0 : 0.5 * drive.irregularity * draw(series.seed, Draw::kBegin, number);
  return (static_cast<double>(number) + shift) * drive.period_s;
}

Breath breath(const MotionDrive& drive, const Series& series, std::int64_t number) noexcept {
  const double begins_s = breath_begins_s(drive, series, number);
  const double ends_s = breath_begins_s(drive, series, number + 1);
  const double pause = drive.pause_share * (1.0 + drive.irregularity * draw(series.seed, Draw::kPause, number));
  const double varied = 1.0 + drive.irregularity * draw(series.seed, Draw::kDepth, number);
  const double cough_share = drive.cough_every_s > 0.0 ? drive.period_s / drive.cough_every_s : 0.0;
  const bool coughs = 0.5 * (1.0 + draw(series.seed, Draw::kCough, number)) < cough_share && number >= 0;
  return {begins_s, (1.0 - pause) * (ends_s - begins_s), ends_s, number == 0 ? varied * series.first_depth : varied,
          coughs};
}

/// The breath at a time; before the first one, breathing was the same.
Breath breath_at(const MotionDrive& drive, const Series& series, double since_s) noexcept {
  auto number = static_cast<std::int64_t>(std::floor(since_s / drive.period_s));
  if (since_s < breath_begins_s(drive, series, number))
    --number;
  else if (since_s >= breath_begins_s(drive, series, number + 1))
    ++number;
  return breath(drive, series, number);
}

struct Phase {
  double value = 0.0, per_s = 0.0;
};

/// Faster at the begin of a breath: phase 0.5 is reached after kInspirationShare of its time.
constexpr double kFaster = (0.5 - kInspirationShare) / (kInspirationShare * (1.0 - kInspirationShare));

Phase phase_in(const Breath& breath, double since_s) noexcept {
  const double at = (since_s - breath.begins_s) / breath.moves_s;
  if (!(at >= 0.0 && at < 1.0)) return {};
  return {at + kFaster * at * (1.0 - at), (1.0 + kFaster * (1.0 - 2.0 * at)) / breath.moves_s};
}

/// A driver's share of its depth, and its slope per phase.
struct Share {
  double value, per_phase;
};

Share share_of(std::size_t driver, double phase) noexcept {
  const double lead = driver == 1 ? kChestLead : 0.0;
  const double angle = std::numbers::pi * (phase + lead * phase * (1.0 - phase));
  const double slope = std::numbers::pi * (1.0 + lead * (1.0 - 2.0 * phase));
  const double sine = std::sin(angle);
  return {sine * sine, 2.0 * sine * std::cos(angle) * slope};
}

/// Adds a breath of a depth to the drivers. No driver exceeds its range.
void add_breath(const MotionDrive& drive, const Phase& phase, double deeper, MotionState& state) noexcept {
  state.phase = phase.value;
  for (std::size_t d = 0; d < kMostDrivers; ++d) {
    const double depth = std::clamp(deeper * drive.depth[d], kLeastDrive, kMostDrive);
    const Share share = share_of(d, phase.value);
    state.drivers[d] += depth * share.value;
    state.rates_per_s[d] += depth * share.per_phase * phase.per_s;
  }
}

/// A cough before the next breath: a quick breath in, then out beyond the resting place.
void add_cough(const MotionDrive& drive, const Breath& breath, double since_s, MotionState& state) noexcept {
  constexpr double kIn_s = 0.5, kOut_s = 0.4, kIn = 0.5, kOut = -0.25;
  const double lasts_s = std::min(kIn_s + kOut_s, 0.5 * (breath.ends_s - breath.begins_s));
  const double at_s = since_s - (breath.ends_s - lasts_s);
  if (!breath.coughs || !(at_s >= 0.0)) return;
  const double in_s = lasts_s * kIn_s / (kIn_s + kOut_s);
  const bool is_in = at_s < in_s;
  const double part_s = is_in ? in_s : lasts_s - in_s, height = is_in ? kIn : kOut;
  const double angle = std::numbers::pi * (is_in ? at_s : at_s - in_s) / part_s;
  for (std::size_t d = 0; d < kMostDrivers; ++d) {
    state.drivers[d] += height * drive.depth[d] * std::sin(angle) * std::sin(angle);
    state.rates_per_s[d] += height * drive.depth[d] * std::sin(2.0 * angle) * std::numbers::pi / part_s;
  }
}

/// What is left of a drift after it ended.
void add_fading(double drifted, double since_s, MotionState& state) noexcept {
  const double t = since_s / kDriftFades_s;
  if (!(t >= 0.0 && t < 1.0)) return;
  state.drivers[0] += drifted * (1.0 - t * t * (3.0 - 2.0 * t));
  state.rates_per_s[0] -= drifted * 6.0 * t * (1.0 - t) / kDriftFades_s;
}

Series own_series(const MotionDrive& drive) noexcept {
  return {drive.seed, drive.first_depth};
}

/// How the patient breathes after a hold.
Series series_after(const MotionDrive& drive, double from_s, double to_s) noexcept {
  return {drive.seed + 1, to_s - from_s > 0.5 * drive.hold_limit_s ? kDeeperAfterHold : 1.0};
}

void add_breathing(const MotionDrive& drive, const Series& series, double since_s, MotionState& state) noexcept {
  const Breath now = breath_at(drive, series, since_s);
  add_breath(drive, phase_in(now, since_s), now.depth, state);
  add_cough(drive, now, since_s, state);
}

}  // namespace

Status check(const MotionDrive& drive) {
  constexpr double kShortest_s = 1.0, kLongest_s = 60.0, kMostTime_s = 1e9, kMostPause = 0.6, kMostIrregularity = 0.4;
  constexpr double kLeastCough_s = 5.0, kMostCough_s = 3600.0, kMostLimit_s = 120.0, kMostDrift_per_s = 0.1;
  const auto is_within = [](double value, double low, double high) { return value >= low && value <= high; };
  const bool has_depth = std::ranges::all_of(drive.depth, [](double d) { return d >= kLeastDrive && d <= kMostDrive; });
  const bool is_good =
      is_within(drive.period_s, kShortest_s, kLongest_s) && is_within(drive.begins_s, -kMostTime_s, kMostTime_s) &&
      is_within(drive.held_phase, 0.0, 1.0) && has_depth && is_within(drive.pause_share, 0.0, kMostPause) &&
      is_within(drive.irregularity, 0.0, kMostIrregularity) &&
      (drive.cough_every_s == 0.0 || is_within(drive.cough_every_s, kLeastCough_s, kMostCough_s)) &&
      is_within(drive.hold_s, -kMostTime_s, kMostTime_s) && is_within(drive.release_s, -kMostTime_s, kMostTime_s) &&
      is_within(drive.first_depth, 0.3, 2.0) && is_within(drive.drifted, -1.0, 1.0) &&
      is_within(drive.hold_limit_s, 0.0, kMostLimit_s) &&
      is_within(drive.drift_per_s, -kMostDrift_per_s, kMostDrift_per_s);
  if (is_good) return {};
  return fail("a number is out of its range", "motion of the patient",
              "use a period of 1 to 60 s, a phase of 0 to 1, depths of at most 1.7; see motion/breathing.h");
}

double hold_begins_s(const MotionDrive& drive) noexcept {
  if (!(drive.hold_s >= 0.0) || drive.hold_limit_s <= 0.0) return MotionDrive::kNever_s;
  const auto moment = static_cast<std::int64_t>(1e3 * drive.hold_s);
  const double share = 0.5 * (1.0 + draw(drive.seed, Draw::kReaction, moment));
  const double reacts_s = drive.hold_s + kFastestReaction_s + share * (kSlowestReaction_s - kFastestReaction_s);
  const Breath now = breath_at(drive, own_series(drive), reacts_s);
  const bool is_in_pause = reacts_s >= now.begins_s + now.moves_s && !now.coughs;
  const double begins_s = is_in_pause ? reacts_s : now.coughs ? now.ends_s : now.begins_s + now.moves_s;
  const bool is_in_vain = drive.release_s >= drive.hold_s && drive.release_s + kResumes_s <= begins_s;
  return is_in_vain ? MotionDrive::kNever_s : begins_s;
}

double hold_ends_s(const MotionDrive& drive) noexcept {
  const double begins_s = hold_begins_s(drive);
  if (begins_s < 0.0) return MotionDrive::kNever_s;
  const double limit_s = begins_s + drive.hold_limit_s;
  return drive.release_s >= drive.hold_s ? std::min(limit_s, drive.release_s + kResumes_s) : limit_s;
}

MotionDrive asked_to_hold(const MotionDrive& drive, double time_s) noexcept {
  MotionDrive next = drive;
  const double since_s = time_s - drive.begins_s, from_s = hold_begins_s(drive), to_s = hold_ends_s(drive);
  if (since_s < 0.0 || (from_s >= 0.0 && since_s < to_s)) return next;
  if (from_s >= 0.0) {  // breaths are counted from the end of the last hold
    const Series series = series_after(drive, from_s, to_s);
    next.begins_s = drive.begins_s + to_s;
    next.seed = series.seed;
    next.first_depth = series.first_depth;
    next.drifted = drive.drift_per_s * (to_s - from_s);
  }
  next.hold_s = time_s - next.begins_s;
  next.release_s = MotionDrive::kNever_s;
  return next;
}

MotionDrive released(const MotionDrive& drive, double time_s) noexcept {
  MotionDrive next = drive;
  const double since_s = time_s - drive.begins_s, to_s = hold_ends_s(drive);
  if (to_s >= 0.0 && drive.release_s < 0.0 && since_s >= drive.hold_s && since_s < to_s) next.release_s = since_s;
  return next;
}

MotionState state_of_phase(const MotionDrive& drive, double phase, double time_s) noexcept {
  MotionState state;
  state.time_s = time_s;
  // phase = at + kFaster * at * (1 - at), solved for the speed.
  const double speed = std::sqrt((1.0 + kFaster) * (1.0 + kFaster) - 4.0 * kFaster * phase);
  const double moves_s = (1.0 - drive.pause_share) * drive.period_s;
  add_breath(drive, {phase, drive.is_held ? 0.0 : speed / moves_s}, 1.0, state);
  return state;
}

MotionState state_at(const MotionDrive& drive, double time_s) noexcept {
  if (drive.is_held) return state_of_phase(drive, drive.held_phase, time_s);
  MotionState state;
  state.time_s = time_s;
  const double since_s = time_s - drive.begins_s;
  const double from_s = hold_begins_s(drive), to_s = hold_ends_s(drive);
  add_fading(drive.drifted, since_s, state);
  if (from_s < 0.0 || since_s < from_s) {
    add_breathing(drive, own_series(drive), since_s, state);
  } else if (since_s < to_s) {
    state.is_breath_held = true;
    state.drivers[0] += drive.drift_per_s * (since_s - from_s);
    state.rates_per_s[0] += drive.drift_per_s;
  } else {
    add_fading(drive.drift_per_s * (to_s - from_s), since_s - to_s, state);
    add_breathing(drive, series_after(drive, from_s, to_s), since_s - to_s, state);
  }
  return state;
}

}  // namespace trocar::motion
