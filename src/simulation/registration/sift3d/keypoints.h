#pragma once

#include <vector>

#include "core/result.h"
#include "registration/sift3d/scale_space.h"

namespace trocar::registration {

struct KeypointOptions {
  double least_contrast = 0.07;  ///< Of the difference of Gaussians, local standard deviations of gray. Range 0..10.
  /// Differences are multiplied by (sigma / first sigma)^scale_exponent, because speckle falls with the scale. Range
  /// 0..1.5; 0: plain differences, 1.5: speckle is equal at all scales.
  double scale_exponent = 1.0;
  double largest_ratio = 15.0;  ///< Largest |lambda_3| / |lambda_1| of the Hessian (paper A). Range 1..1000.
  std::size_t most = 20000;     ///< The keypoints of the highest contrast are kept. Range 1..1,000,000.
};

/// Extremum of the difference of Gaussians over place and scale.
struct Keypoint {
  Vec3 p_P{0, 0, 0};      ///< mm.
  double sigma_mm = 0.0;  ///< Scale.
  double contrast = 0.0;  ///< Difference of Gaussians as compared, so weighted; negative at bright places.
  double ratio = 1.0;     ///< |lambda_3| / |lambda_1|.
  std::size_t octave = 0;
  double level = 0.0;  ///< Within the octave.
};

/// Finds keypoints (docs/physics.md R3): extrema among 26 + 27 + 27 neighbours, refined to a fraction of voxel and
/// scale, without those of low contrast or along edges. In falling order of contrast. Errors (exit status 2): options
/// out of range.
Result<std::vector<Keypoint>> find_keypoints(const ScaleSpace& space, const KeypointOptions& options = {});

}  // namespace trocar::registration
