#pragma once

#include "volume/grid.h"

namespace trocar::registration {

/// Means of usable values with Gaussian weights of `sigma_mm`; NaN where a voxel is not usable. Same grid.
volume::FloatGrid smooth_usable(const volume::FloatGrid& values, const volume::MaskGrid& usable, double sigma_mm);

}  // namespace trocar::registration
