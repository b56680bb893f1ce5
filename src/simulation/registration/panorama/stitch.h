#pragma once

#include <optional>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "registration/intensity/rigid_alignment.h"
#include "registration/panorama/blend.h"
#include "registration/panorama/pair_registration.h"

namespace trocar::registration {

/// Measured motion between two nodes.
struct PoseEdge {
  std::size_t a = 0, b = 0;
  Pose X_AB;
  /// Inverse covariance of a rotation (rad) about `middle_A` and a translation (mm), in A.
  Matrix6 information = Matrix6::Identity();
  Vec3 middle_A{0, 0, 0};
  double strength = 1.0;  ///< Of two contradicting edges, the weaker one is removed.
};

/// All above 0 (checked).
struct PoseGraphOptions {
  double arm_mm = 40.0;     ///< Half the size of a volume: length at which a rotation counts as a distance.
  double largest_mm = 3.0;  ///< Largest contradiction of an edge with the others.
  double robust_mm = 0.5;   ///< Contradictions above this count less (Cauchy).
};

struct PoseGraph {
  std::vector<std::optional<Pose>> X_0N;  ///< Pose of each node in the first; empty: not connected with it.
  std::vector<std::size_t> removed;       ///< Indices of contradicting edges.
  std::vector<double> contradiction_mm;   ///< Of each edge, after the solution; 0 if one of its nodes has no pose.
};

/// Poses that fit all edges best (docs/physics.md R18): least squares on SE(3) by Levenberg-Marquardt with Cauchy's
/// weights, from the tree of the strongest edges. Edges that contradict the others by more than `largest_mm` are
/// removed one by one. Deterministic.
PoseGraph solve_pose_graph(std::size_t nodes, const std::vector<PoseEdge>& edges, const PoseGraphOptions& options = {});

struct StitchOptions {
  PairOptions pair;
  PoseGraphOptions graph;
};

/// A pair of volumes in the graph.
struct StitchEdge {
  PairRegistration pair;
  bool is_used = false;           ///< Found, and in agreement with the others.
  double contradiction_mm = 0.0;  ///< With the poses of all.
};

struct Stitching {
  std::vector<std::optional<Pose>> X_0N;  ///< From each volume to the first; empty: not placed.
  std::vector<StitchEdge> edges;          ///< All pairs that were tried.
};

/// Finds the pose of every volume in the first (docs/physics.md R18): all pairs, the graph of the found ones, then
/// again with every overlapping pair refined at full detail. Volumes without a trustworthy connection to the first have
/// no pose. Errors (exit status 2): options out of range, fewer than two volumes.
Result<Stitching> stitch(const std::vector<PreparedVolume>& volumes, const StitchOptions& options = {},
                         const Progress& progress = {});

}  // namespace trocar::registration
