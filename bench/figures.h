#pragma once

#include <optional>
#include <vector>

namespace trocar::bench {

/// Figures of many measurements of a quantity, in its unit; a field that does not apply stays empty.
struct Figures {
  std::optional<double> median, p99, p999, max;
};

/// Median, p99, p99.9 and maximum of any numbers, by nearest rank. A tail is empty if there are too few values to
/// resolve it: p99 below 100, p99.9 below 1000.
Figures figures_of(std::vector<double> values);
/// A single number: the median.
Figures figure_of(double value);

}  // namespace trocar::bench
