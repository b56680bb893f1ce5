#pragma once

#include <array>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "geometry/vec.h"
#include "volume/grid.h"

namespace trocar::patient_builder::detail {

/// Where the voxels of a label lie: the ellipsoid with the same moments.
struct LabelShape {
  double voxels = 0.0;
  Vec3 middle_P = Vec3::Zero();
  Vec3 axes_mm = Vec3::Zero();  ///< Lengths of the ellipsoid's axes, the shortest first.
  /// Volume by that of the ellipsoid: 1 for an ellipsoid, 0.7 for a liver, near 0 for scattered voxels and shells.
  double fullness = 0.0;
};

using LabelShapes = std::array<LabelShape, 256>;  ///< By label.

/// Labels without voxels have none. Axes of the grid along P.
LabelShapes find_label_shapes(const volume::LabelGrid& labels);

/// How often structures lie on the side of each other that their names say, along one axis of P.
struct AxisVotes {
  int right = 0, wrong = 0;
  std::vector<std::string> wrong_ones;  ///< "liver on the left".
  std::vector<std::string> misplaced;   ///< Those of them that lie on one side in nearly everybody.
  bool is_reversed() const noexcept { return wrong >= 2 && wrong > 2 * right; }
};

/// Votes along x (left), y (back) and z (head). `middle_x_P`: of the body, for a segmentation without a spine.
std::array<AxisVotes, 3> vote_directions(const LabelShapes& shapes, double voxel_ml, const anatomy::LabelTable& table,
                                         double middle_x_P);

}  // namespace trocar::patient_builder::detail
