#pragma once

#include <vector>

#include "volume/grid.h"

namespace trocar::ultrasound::detail {

/// A place on the middle line of a tube.
struct CentrelineNode {
  Vec3 p_P = Vec3::Zero();
  Vec3 tangent_P = Vec3::UnitZ();  ///< Unit, away from the root.
  double radius_mm = 0.0;          ///< Of the largest ball in the tube there.
  int parent = -1;                 ///< Index of the node nearer to the root, smaller than its own; -1: the root.
  /// Lies within the tube that its branch leaves: of no tube of its own.
  bool is_within_parent = false;
};

/// The middle lines of one connected piece of tubes, without loops. Its ends are a radius or a little more short of the
/// tubes' ends.
struct CentrelineTree {
  struct Tip {
    int node = 0;
    Vec3 p_P = Vec3::Zero();  ///< Where the tube itself ends.
    double radius_mm = 0.0;   ///< Mean over the last part.
  };
  std::vector<CentrelineNode> nodes;  ///< [0] is the root, at one end of the longest way.
  std::vector<Tip> tips;              ///< [0] is that of the root.
};

/// Middle lines of what is inside (depth_mm > 0: distance from the wall), one tree for each piece of at least
/// `least_mm3`. Paths are those of least cost from the root, a mm costing 1/depth³, so that they keep to the middle;
/// the farthest place that no path passes begins the next one (after Sato et al., TEASAR, Pacific Graphics 2000, doi
/// 10.1109/PCCGA.2000.883951). Smoothed by lines of least squares. About isotropic voxels.
std::vector<CentrelineTree> find_centrelines(const volume::FloatGrid& depth_mm, double least_mm3 = 100.0);

}  // namespace trocar::ultrasound::detail
