#pragma once

#include "volume/grid.h"

namespace trocar::volume {

/// Convolves a volume with a Gaussian of `sigma_voxels` (each >= 0, checked; 0 leaves an axis as it is), sampled and
/// cut at 4 sigma, of sum 1. Beyond the grid the volume is 0. Parallel, SIMD selected at run time; the result does not
/// depend on the number of threads.
void gaussian_blur(FloatGrid& grid, const Vec3& sigma_voxels);

}  // namespace trocar::volume
