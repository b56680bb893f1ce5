#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

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

}  // namespace trocar::cohort
