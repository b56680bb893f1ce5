#pragma once

#include <vector>

#include "volume/grid.h"

namespace trocar::volume {

/// A point on the centreline of a tube.
struct CentrelineNode {
  Vec3 p_P = Vec3::Zero();
  Vec3 tangent_P = Vec3::UnitZ();  ///< Unit, away from the root.
  double radius_mm = 0.0;          ///< Radius of the largest ball in the tube there.
  int parent = -1;  ///< Index of the adjacent node nearer to the root, smaller than the node's own index; -1: the root.
  /// The node lies within the tube that its branch leaves, not in a tube of its own.
  bool is_within_parent = false;
};

/// Centrelines of one connected piece of tubes, without loops. The ends of the centrelines are a radius or a little
/// more short of the tubes' ends.
struct CentrelineTree {
  struct Tip {
    int node = 0;
    Vec3 p_P = Vec3::Zero();  ///< End of the tube.
    double radius_mm = 0.0;   ///< Mean radius over the last part.
  };
  std::vector<CentrelineNode> nodes;  ///< [0] is the root, at one end of the longest path.
  std::vector<Tip> tips;              ///< [0] is the tip at the root.
};

/// Centrelines of the inside of a structure (depth_mm > 0: distance from the wall), one tree for each piece of at least
/// `least_mm3`. Paths have the least cost from the root, with a cost of 1/depth³ per mm, so that they stay in the
/// middle. The farthest point that no path passes starts the next path (after Sato et al., TEASAR, Pacific Graphics
/// 2000, doi 10.1109/PCCGA.2000.883951). Paths are smoothed by least-squares lines. Voxels must be about isotropic.
std::vector<CentrelineTree> find_centrelines(const FloatGrid& depth_mm, double least_mm3 = 100.0);

}  // namespace trocar::volume
