#pragma once

#include <span>
#include <vector>

#include "cohort/summary.h"
#include "core/result.h"

namespace trocar::cohort {

/// Internal consistency of a score that is the sum of items (Cronbach 1951).
struct Alpha {
  double value = 0.0;  ///< 1: all items order the people alike; about 0: they have nothing in common; may be negative.
  Interval interval;   ///< Feldt 1965: assumes normally distributed items with equal variances and covariances.
  std::size_t items = 0, people = 0;
};

/// `people`: the items of each person, in the same order and unit (the total is their sum). Errors: fewer than two
/// people or items, rows of different length, a value that is not finite, all people have the same total score.
Result<Alpha> cronbach_alpha(std::span<const std::vector<double>> people);

}  // namespace trocar::cohort
