#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/result.h"
#include "registration/sift3d/descriptor.h"
#include "registration/sift3d/keypoints.h"
#include "volume/grid.h"

namespace trocar::registration {

inline constexpr int kGrayBins = 16;
/// Shares of the gray levels near a keypoint; their sum is 1, or 0 where no voxel is usable.
using GrayHistogram = std::array<float, kGrayBins>;

/// Histograms of the usable voxels in 8 x 8 x 8 voxels about each keypoint. Bins: ranks among the usable gray levels of
/// the whole volume (each bin contains a sixteenth of them), so that neither gain nor a rising gray map changes them.
std::vector<GrayHistogram> gray_histograms(const volume::LabelGrid& gray, const volume::MaskGrid& usable,
                                           const std::vector<Keypoint>& keypoints);

/// Half the sum of absolute differences, with neighbouring bins taken together: 0 (equal)..1.
double histogram_distance(const GrayHistogram& a, const GrayHistogram& b) noexcept;

struct MatchOptions {
  double largest_ratio = 0.95;         ///< Of the distances to the nearest and second-nearest. Range 0.1..1.
  double largest_gray_distance = 0.6;  ///< Between gray histograms, 0..1. Range 0..1.
  bool is_mutual = true;               ///< Each is the other's nearest.
};

/// A pair of keypoints of two volumes.
struct Match {
  std::uint32_t a = 0, b = 0;  ///< Indices of keypoints.
  std::uint32_t feature_a = 0, feature_b = 0;
  double distance = 0.0;  ///< Between descriptors, 0..2.
  double ratio = 1.0;
  double gray_distance = 0.0;
};

/// Keypoints of a volume with everything that matching reads.
struct KeypointSet {
  std::vector<Keypoint> keypoints;
  Features features;
  std::vector<GrayHistogram> gray;  ///< Of each keypoint.
};

/// Matches the features of two volumes (docs/physics.md R6): nearest descriptor by exact products, ratio to the nearest
/// one of another keypoint, mutual, similar gray levels. At most one match per pair of keypoints, in falling order of
/// ratio's quality. Errors (exit status 2): options out of range.
Result<std::vector<Match>> match(const KeypointSet& a, const KeypointSet& b, const MatchOptions& options = {});

}  // namespace trocar::registration
