#pragma once

#include <array>
#include <vector>

#include "registration/sift3d/descriptor.h"

namespace trocar::registration::detail {

/// Histograms of gradients in 4 x 4 x 4 regions, not yet normalised. Element ((region * 8) + theta) * 4 + phi.
class GradientHistogram {
 public:
  explicit GradientHistogram(double sample_sigma);
  /// Fills the histogram in the frame R_PK about a keypoint; returns the usable share of the samples, 0..1.
  double fill(const ScaleSpace& space, const Keypoint& keypoint, const Mat3& R_PK);
  std::array<float, kDescriptorSize>& elements() noexcept { return elements_; }

 private:
  static constexpr int kSamples = kRegions * kRegionSamples;
  static constexpr int kPadded = kSamples + 2;  ///< With a sample beside the first and the last, for differences.

  void sample(const volume::FloatGrid& gray, const Vec3& first, const Mat3& steps);
  void add(int i, int j, int k, const Eigen::Vector3f& gradient);
  float gray_at(int i, int j, int k) const noexcept {
    return gray_[static_cast<std::size_t>((k * kPadded + j) * kPadded + i)];
  }

  double sample_sigma_;
  std::vector<float> gray_;    ///< kPadded^3 samples.
  std::vector<float> window_;  ///< kSamples^3 weights.
  std::array<float, kDescriptorSize> elements_{};
};

}  // namespace trocar::registration::detail
