#pragma once

#include <algorithm>
#include <span>
#include <string>

namespace trocar::tasks {

/// A time in which the trainee could not act: a haptic server was unavailable, or no tick was answered. Session times;
/// `to_s` is the time of the first tick after it.
struct Interruption {
  double from_s = 0.0;
  double to_s = 0.0;
  std::string reason;  ///< One of the words below.
};
/// Why; after this one the insertion restarts at the needle's pose.
inline constexpr const char* kServerWasAway = "the needle's server was away";
inline constexpr const char* kServerSentNothing = "the needle's server sent no data";
inline constexpr const char* kProgramDidNotRun = "the program did not run";
inline constexpr const char* kSamplesWereLost = "samples were lost";

/// Shorter ones are counted and not listed: a hand does not notice them. [assumed]
inline constexpr double kNoticedInterruption_s = 0.1;

/// Time from `from_s` to `to_s` in which the trainee could act. Interruptions do not overlap.
inline double active_time_s(double from_s, double to_s, std::span<const Interruption> interruptions) noexcept {
  double time_s = std::max(0.0, to_s - from_s);
  for (const Interruption& gap : interruptions)
    time_s -= std::max(0.0, std::min(to_s, gap.to_s) - std::max(from_s, gap.from_s));
  return std::max(0.0, time_s);
}

}  // namespace trocar::tasks
