#pragma once

#include <cstdint>
#include <vector>

#include "core/result.h"
#include "registration/matching/gray_histogram.h"
#include "registration/sift3d/descriptor.h"

namespace trocar::registration {

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
