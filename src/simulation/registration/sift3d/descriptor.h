#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "registration/sift3d/keypoints.h"
#include "registration/sift3d/orientation.h"

namespace trocar::registration {

inline constexpr int kRegions = 4;        ///< Sub-regions along an edge.
inline constexpr int kRegionSamples = 4;  ///< Samples along an edge of a sub-region.
inline constexpr int kThetaBins = 8;      ///< Of 45 degrees.
inline constexpr int kPhiBins = 4;
inline constexpr std::size_t kDescriptorSize =
    static_cast<std::size_t>(kRegions) * kRegions * kRegions * kThetaBins * kPhiBins;  // 2048
/// Length of a descriptor: elements are whole numbers, so that products are exact.
inline constexpr int kDescriptorNorm = 1 << 14;

/// Histograms of the gray gradients near a keypoint, in its own orientation.
using Descriptor = std::array<std::int16_t, kDescriptorSize>;

struct DescriptorOptions {
  double sample_sigma = 0.75;     ///< Distance between samples, in units of the keypoint's scale. Range 0.1..4.
  double least_usable = 0.3;      ///< Share of usable samples; less: no descriptor. Range 0..1.
  double largest_element = 0.06;  ///< Of the unit vector, then it is scaled to unit length again. Range 0.02..1.
  OrientationOptions orientation{};
};

/// A keypoint in one of its orientations.
struct Feature {
  std::size_t keypoint = 0;  ///< Index of the keypoint.
  Mat3 R_PK = Mat3::Identity();
};

struct Features {
  std::vector<Feature> features;  ///< In the order of keypoints.
  std::vector<Descriptor> descriptors;
};

/// Describes keypoints (docs/physics.md R5): gradients at 16 x 16 x 16 samples of the keypoint's scale, rotated to its
/// orientation, in 4 x 4 x 4 histograms of 8 theta x 4 phi, each bin divided by its solid angle. Keypoints without
/// orientation or with too few usable samples have no feature. Parallel. Errors (exit status 2): options out of range.
Result<Features> describe(const ScaleSpace& space, const std::vector<Keypoint>& keypoints,
                          const DescriptorOptions& options = {}, const Progress& progress = {});

/// Distance of two descriptors as unit vectors, 0..2.
double descriptor_distance(const Descriptor& a, const Descriptor& b) noexcept;

}  // namespace trocar::registration
