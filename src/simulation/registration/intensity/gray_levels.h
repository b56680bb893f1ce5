#pragma once

#include "core/result.h"
#include "volume/grid.h"

namespace trocar::registration {

/// Gray level to show white: 99.5 % of the levels above 0 are lower; at least 32. 255 for an empty volume.
double bright_gray(const volume::LabelGrid& gray);

/// Gray levels less their local mean, over their local standard deviation, both over usable voxels with Gaussian
/// weights of `sigma_mm`: gain, TGC and a smooth gray map have no effect (docs/physics.md R2). 0 at unusable voxels.
/// `usable` lies on the grid of `gray` (checked). Errors: no usable voxel, or all of one gray level.
Result<volume::FloatGrid> flatten(const volume::LabelGrid& gray, const volume::MaskGrid& usable,
                                  double sigma_mm = 16.0);

/// Means of usable values with Gaussian weights of `sigma_mm`; NaN where a voxel is not usable. Same grid.
volume::FloatGrid smooth_usable(const volume::FloatGrid& values, const volume::MaskGrid& usable, double sigma_mm);

}  // namespace trocar::registration
