#pragma once

#include <cstdint>
#include <vector>

#include "volume/grid.h"

namespace trocar::volume {

/// Connected components of a mask (6-neighbours), numbered from 1 by falling size; 0 outside the mask.
struct Components {
  Grid<std::int32_t> ids;
  std::vector<std::size_t> voxel_counts;  ///< voxel_counts[n-1]: size of component n.
};
Components connected_components(const MaskGrid& mask);

/// The largest component only (the first in memory if sizes are equal); an empty mask stays empty.
MaskGrid largest_component(const MaskGrid& mask);
/// Fills the holes of a mask that do not reach the border of the grid (6-neighbours).
MaskGrid fill_holes(const MaskGrid& mask);
/// Fills holes slice by slice (k planes, 4-neighbours): also closes channels that leave the grid above or below.
MaskGrid fill_holes_in_slices(const MaskGrid& mask);
/// Dilates the mask by a ball: the voxels whose centre lies within radius_mm of a voxel centre of the mask. Exact in
/// mm. A negative radius erodes.
MaskGrid dilate(const MaskGrid& mask, double radius_mm);
/// Erodes the mask by a ball: the voxels of the mask farther than radius_mm from every voxel centre outside of the
/// mask. Space beyond the grid does not count as outside. A negative radius dilates.
MaskGrid erode(const MaskGrid& mask, double radius_mm);

}  // namespace trocar::volume
