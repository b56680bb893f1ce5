#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar::cohort {

/// Confidence interval of 95 %.
struct Interval {
  double low = 0.0, high = 0.0;
};

/// Which direction of a value is better.
enum class Better { kLower, kHigher, kNeither };

/// Error: a value is not finite; `what` names the values ("the experts' values").
Status check_finite(std::span<const double> values, std::string_view what);

/// Precondition: not empty.
double mean_of(std::span<const double> values);
/// Of a sample: with n − 1. Precondition: at least two values.
double standard_deviation_of(std::span<const double> values);

/// The value below which a share of the values lies, interpolated linearly between the sorted values x_1 … x_n at the
/// position 1 + (n − 1) share (type 7 of Hyndman and Fan 1996). `share` 0..1. Empty: no values.
std::optional<double> quantile_of(std::span<const double> values, double share);

/// Five numbers of a distribution. Empty: no values.
struct Quartiles {
  double min = 0.0, q1 = 0.0, median = 0.0, q3 = 0.0, max = 0.0;
};
std::optional<Quartiles> quartiles_of(std::span<const double> values);

/// Attempts of a person, counted from 1 in the order of recording.
struct AttemptRange {
  std::size_t first = 1;
  std::size_t last = std::numeric_limits<std::size_t>::max();
};
/// Mean over a person's attempts within the range. Attempts without a value, or with one that is not finite, count as
/// attempts but not in the mean. Empty: no value within the range.
std::optional<double> person_mean(std::span<const std::optional<double>> by_attempt, const AttemptRange& range = {});

/// At each attempt the mean of the last `window` (≥ 1) scores up to it; fewer at the beginning. An attempt without a
/// score has the mean of the attempt before it. Empty: no score so far.
std::vector<std::optional<double>> moving_mean(std::span<const std::optional<double>> scores, std::size_t window);

/// Median of the slopes between all pairs of scored attempts, score an attempt (Theil 1950, Sen 1968): positive for a
/// person who improves; one outlier does not change it much. Empty: fewer than three scores.
std::optional<double> trend_per_attempt(std::span<const std::optional<double>> scores);

/// Rates that a CUSUM curve tests. Both rates are assumed: choose them for the procedure.
struct CusumRates {
  double acceptable = 0.2;    ///< Failure rate p0 of a competent person. Range 0.001..0.9.
  double unacceptable = 0.4;  ///< Failure rate p1 that must be detected. Above p0, at most 0.999.
  double alpha = 0.1;         ///< Risk that a person with p0 is found unacceptable. Range 0.001..0.499.
  double beta = 0.1;          ///< Risk that a person with p1 is found acceptable. Range 0.001..0.499.
};

/// CUSUM learning curve (Kestin 1995; Bolsin and Colson 2000): Wald's sequential test of the failure rate. Each
/// failure raises the sum by 1 − s, each pass lowers it by s. Beyond a limit the test has decided; the next attempt
/// begins a new test at 0.
struct Cusum {
  enum class Decision { kAcceptable, kUnacceptable };
  struct Signal {
    std::size_t attempt;  ///< Counted from 1.
    Decision decision;
  };

  double pass_step = 0.0;       ///< s.
  double lower = 0.0;           ///< Negative; at or below: the failure rate is acceptable.
  double upper = 0.0;           ///< Positive; at or above: it is unacceptable.
  std::vector<double> values;   ///< The sum after each attempt.
  std::vector<Signal> signals;  ///< Decisions in order; the last one is valid until the next.
};
/// `passed`: of each attempt that has a result, in the order of recording. Errors: rates outside of their ranges, or
/// not finite.
Result<Cusum> cusum_of(const std::vector<bool>& passed, const CusumRates& rates = {});

/// A group at one attempt number.
struct CurvePoint {
  std::size_t people = 0;                 ///< With a score at this attempt.
  double mean = 0.0;                      ///< Of their scores.
  std::optional<Interval> interval = {};  ///< Of the mean (Student); empty: fewer than two people.
};
/// Mean curve of a group by attempt number (the first element: first attempts). `people`: the scores of each person by
/// attempt. It ends with the last attempt that anyone scored; an attempt number that no one scored is empty. People who
/// stopped early leave the mean: compare `people`.
std::vector<std::optional<CurvePoint>> mean_curve(std::span<const std::vector<std::optional<double>>> people);

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
