#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trocar::registration::detail {

/// Mutual information of R12 between gray levels and values that change, with its derivative by each value. The caller
/// continues the chain rule: to six parameters of a motion, or to the nodes of a B-spline. Parallel over parts of fixed
/// length, whose sums are added in order: bitwise independent of the number of threads.
class SampledInformation {
 public:
  /// `us`: local contrasts, -3..3.
  explicit SampledInformation(std::span<const float> us);
  /// Nats. `ct`: local contrasts at the same samples (as many, checked); NaN: no value there, the sample does not
  /// count. 0 without any value.
  double value(std::span<const double> ct) const;
  /// The same; `slopes` receives the derivatives per unit of contrast.
  double evaluate(std::span<const double> ct, std::vector<double>& slopes) const;

 private:
  std::vector<std::uint8_t> us_bins_;
};

}  // namespace trocar::registration::detail
