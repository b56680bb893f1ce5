#pragma once

#include <cstdint>
#include <vector>

#include "volume/grid.h"

namespace trocar {

/// Connected components of a mask (6-neighbours), numbered from 1 by falling size; 0 outside the mask.
struct Components {
  Grid<std::int32_t> ids;
  std::vector<std::size_t> voxel_counts;  ///< voxel_counts[n-1]: size of component n.
};
Components connected_components(const MaskGrid& mask);

/// The largest component alone; an empty mask stays empty.
MaskGrid largest_component(const MaskGrid& mask);
/// Fills the holes of a mask that do not reach the border of the grid.
MaskGrid fill_holes(const MaskGrid& mask);
/// The same slice by slice (k planes): also closes channels that run out of the grid above or below.
MaskGrid fill_holes_in_slices(const MaskGrid& mask);
/// Grown (radius > 0) or shrunk (radius < 0) by a ball of |radius_mm|, exact in mm.
MaskGrid dilate(const MaskGrid& mask, double radius_mm);
MaskGrid erode(const MaskGrid& mask, double radius_mm);

}  // namespace trocar
