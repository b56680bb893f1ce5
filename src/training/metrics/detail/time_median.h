#pragma once

#include <algorithm>
#include <optional>
#include <vector>

namespace trocar::metrics::detail {

/// Median over time of a value in 0..largest, from a histogram: accurate to half of a bin. Larger values count as
/// `largest`.
class TimeMedian {
 public:
  TimeMedian(double largest, double bin) : bin_(bin), seconds_(static_cast<std::size_t>(largest / bin) + 1, 0.0) {}

  void add(double value, double dt_s) {
    const auto n = static_cast<std::size_t>(std::max(0.0, value) / bin_);
    seconds_[std::min(n, seconds_.size() - 1)] += dt_s;
    total_s_ += dt_s;
  }
  /// Empty: no time was added.
  std::optional<double> median() const {
    if (!(total_s_ > 0.0)) return std::nullopt;
    double sum_s = 0.0;
    for (std::size_t n = 0; n < seconds_.size(); ++n) {
      sum_s += seconds_[n];
      if (sum_s >= 0.5 * total_s_) return (static_cast<double>(n) + 0.5) * bin_;
    }
    return static_cast<double>(seconds_.size()) * bin_;
  }

 private:
  double bin_;
  std::vector<double> seconds_;  ///< By bin.
  double total_s_ = 0.0;
};

}  // namespace trocar::metrics::detail
