#pragma once

#include <span>
#include <vector>

#include "registration/ct_ultrasound/detail/working_images.h"

namespace trocar::registration::detail {

/// Mutual information of R12 between gray levels and values that change, with its derivative by each value. ITK
/// computes dense Jacobians for B-splines; with the derivative by the value, only 64 nodes per sample are touched.
class SampledInformation {
 public:
  /// `us`: local contrasts, -3..3.
  explicit SampledInformation(std::span<const float> us);
  /// Nats. `ct`: local contrasts at the same samples (as many, checked); `slopes` receives the derivatives per unit of
  /// contrast.
  double evaluate(std::span<const double> ct, std::vector<double>& slopes);

 private:
  std::vector<std::size_t> us_bins_;
};

}  // namespace trocar::registration::detail
