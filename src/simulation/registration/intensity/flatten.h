#pragma once

#include "core/result.h"
#include "volume/grid.h"

namespace trocar::registration {

/// Gray levels less their local mean, over their local standard deviation, both over usable voxels with Gaussian
/// weights of `sigma_mm`: gain, TGC and a smooth gray map have no effect (docs/physics.md R2). 0 at unusable voxels.
/// `usable` lies on the grid of `gray` (checked). Errors: no usable voxel, or all of one gray level.
Result<volume::FloatGrid> flatten(const volume::LabelGrid& gray, const volume::MaskGrid& usable,
                                  double sigma_mm = 16.0);

}  // namespace trocar::registration
