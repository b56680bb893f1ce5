#pragma once

#include "surface/extract_surface.h"

namespace trocar::detail {

/// How much of each voxel a mask fills, 0..255, on a grid made coarser by whole factors until its spacing is about
/// `spacing_mm` (0: the mask's own grid).
Grid<std::uint8_t> occupancy(const MaskGrid& mask, double spacing_mm);

/// Contour of a half filled voxel, smoothed and decimated with VTK's filters; in mm along the grid's axes from voxel
/// (0,0,0), closed, triangles outward.
TriangleMesh contour(const Grid<std::uint8_t>& occupancy, const SurfaceOptions& options);

}  // namespace trocar::detail
