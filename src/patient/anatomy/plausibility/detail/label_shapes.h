#pragma once

#include <array>

#include "geometry/vec.h"
#include "volume/grid.h"

namespace trocar::anatomy::detail {

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

}  // namespace trocar::anatomy::detail
