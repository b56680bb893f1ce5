#pragma once

#include <cstddef>
#include <span>

#include "core/result.h"

namespace trocar::cohort {

/// Normal distribution fitted to the scores of a group.
struct ScoreDistribution {
  std::size_t people = 0;
  double mean = 0.0;
  double sd = 0.0;  ///< Of a sample (n − 1).
};

/// Pass mark by contrasting groups (Jørgensen, Konge, Subhi 2018): the score between both means at which the fitted
/// densities are equal. From this score on, a person passes.
struct PassMark {
  double value = 0.0;
  ScoreDistribution experts, novices;
  double expected_false_pass = 0.0;  ///< Share of novices at or above the mark, by their fitted distribution.
  double expected_false_fail = 0.0;  ///< Share of experts below it.
  std::size_t false_passes = 0;      ///< Novices at or above the mark.
  std::size_t false_fails = 0;       ///< Experts below it.
};

/// One score a person, higher is better. Errors, each with the reason: fewer than two people in a group, a score that
/// is not finite, a group in which all scores are equal, experts who are not better, distributions that do not cross
/// between their means.
Result<PassMark> contrasting_groups(std::span<const double> experts, std::span<const double> novices);

}  // namespace trocar::cohort
