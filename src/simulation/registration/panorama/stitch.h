#pragma once

#include <optional>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "registration/panorama/blend.h"
#include "registration/panorama/pair_registration.h"
#include "registration/panorama/pose_graph.h"

namespace trocar::registration {

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
