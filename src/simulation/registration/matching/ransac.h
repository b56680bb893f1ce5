#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"

namespace trocar::registration {

struct RansacOptions {
  double inlier_mm = 3.0;          ///< Largest distance of a pair that agrees. Range 0.01..100.
  double certainty = 0.999;        ///< Probability that a sample without a wrong pair was drawn. Range 0.5..0.999999.
  int most_trials = 200000;        ///< Range 1..10,000,000.
  double least_triangle_mm = 8.0;  ///< Height of a sample's triangle; flatter ones are rejected. Range 0..1000.
  std::uint64_t seed = 1;
};

/// Two points that may be the same place, in two volumes.
struct PointPair {
  Vec3 a{0, 0, 0}, b{0, 0, 0};  ///< mm, in the frames of volume A and B.
};

struct RigidMotion {
  Pose X_AB;
  std::vector<std::size_t> inliers;  ///< Indices of the pairs that agree.
  double rms_mm = 0.0;
  int trials = 0;
  /// 0..1: one less the expected number of motions that as many of these pairs would support if they were unrelated.
  double confidence = 0.0;
};

/// The rigid motions with the most support (docs/physics.md R7), the best first, at most `most` that differ from each
/// other. From samples of 3 pairs, with the number of trials adapted to the best one so far; least squares over the
/// pairs that agree. Deterministic for a seed. `extent_mm`: size of the volumes, for the confidence. Empty if no three
/// pairs agree. Errors (exit status 2): options out of range.
Result<std::vector<RigidMotion>> find_motions(std::span<const PointPair> pairs, double extent_mm,
                                              const RansacOptions& options, std::size_t most = 1);

}  // namespace trocar::registration
