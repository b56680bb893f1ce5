#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace trocar::ultrasound {

/// Visibility of a target against its surroundings, from the values (envelope or gray) of both.
struct TargetVisibility {
  double contrast_db = 0.0;  ///< Ratio of the root mean squares inside and outside.
  double cnr = 0.0;          ///< |difference of means| / root of the sum of variances.
  double gcnr = 0.0;  ///< 1 - overlap of the histograms, 0..1 (Rodriguez-Molares 2020, doi 10.1109/TUFFC.2019.2956855).
};
TargetVisibility target_visibility(std::span<const float> inside, std::span<const float> outside);

/// Share of each gray value; sums to 1.
using GrayHistogram = std::array<double, 256>;
GrayHistogram gray_histogram(std::span<const std::uint8_t> grays);
/// Mean number of gray levels by which pixels must be moved to turn one histogram into the other. Range 0..255.
double earth_mover_distance(const GrayHistogram& a, const GrayHistogram& b) noexcept;
/// -ln of the sum of sqrt(a b); 0 for equal ones, infinite for disjoint ones.
double bhattacharyya_distance(const GrayHistogram& a, const GrayHistogram& b) noexcept;
/// Least gray value that at least the given share (0..1) of pixels does not exceed.
int gray_percentile(const GrayHistogram& histogram, double share) noexcept;
double mean_gray(const GrayHistogram& histogram) noexcept;

}  // namespace trocar::ultrasound
