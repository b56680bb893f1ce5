// A shared library with all of a module in it, as an interpreter loads one: every object must be position independent.
#include "volume/resample.h"

extern "C" double voxels_of_a_millimetre() {
  const trocar::volume::GridGeometry grid{{2, 2, 2}, {0.5, 0.5, 0.5}};
  return static_cast<double>(trocar::volume::isotropic_geometry(grid, 0.25).voxel_count());
}
