#pragma once

#include <vector>

#include "core/result.h"
#include "registration/sift3d/keypoints.h"

namespace trocar::registration {

struct OrientationOptions {
  double least_peak = 0.8;  ///< A further peak counts from this share of the highest on. Range 0.1..1.
  int most = 4;             ///< Orientations of a keypoint. Range 1..16.
};

/// Orientations R_PK of a keypoint (docs/physics.md R4): the x axis (theta = phi = 0) of K is the dominant direction of
/// the gray gradients near the keypoint, and the y axis is the dominant direction of their parts across x, so that the
/// roll about x is determined. The highest peaks of either first; empty where too few gradients are usable. Errors
/// (exit status 2): options out of range.
class OrientationFinder {
 public:
  static Result<OrientationFinder> make(const OrientationOptions& options = {});
  std::vector<Mat3> find(const ScaleSpace& space, const Keypoint& keypoint) const;

 private:
  OrientationOptions options_;
  std::vector<Vec3> directions_;              ///< Evenly over the sphere.
  std::vector<std::vector<int>> neighbours_;  ///< Of each direction.
};

}  // namespace trocar::registration
