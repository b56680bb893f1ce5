#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cohort/summary.h"
#include "core/result.h"

namespace trocar::cohort {

/// How long it took a person to reach something, or how long the person was followed without reaching it (censored).
struct FollowUp {
  double time = 0.0;  ///< Attempts, minutes …; not negative.
  bool is_reached = false;
};

/// Kaplan–Meier estimate (Kaplan and Meier 1958) of the share of people who have not reached it by a time. People who
/// stopped earlier count as long as they were followed: leaving them out would make the median too small.
struct Survival {
  struct Step {
    double time = 0.0;
    std::size_t at_risk = 0;  ///< People followed until this time.
    std::size_t reached = 0;  ///< Of them, at this time.
    double open_share = 1.0;  ///< Of people who have not reached it after this time.
    Interval interval;        ///< Of the share: Greenwood's variance of its logarithm.
  };
  std::size_t people = 0, reached = 0;
  std::vector<Step> steps;  ///< At each time at which someone reached it.
  /// The first time at which at most half have not reached it; empty: more than half have not, so far.
  std::optional<double> median;
  /// 95 % limits of the median (Brookmeyer and Crowley 1982): the first times at which the share's limits are at most
  /// one half; empty: open.
  std::optional<double> low, high;

  std::size_t censored() const noexcept { return people - reached; }
};

/// Errors: nobody; a time that is negative or no number.
Result<Survival> survival_of(std::span<const FollowUp> people);

}  // namespace trocar::cohort
