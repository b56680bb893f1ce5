#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cohort/summary.h"
#include "core/result.h"

namespace trocar::cohort {

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

}  // namespace trocar::cohort
