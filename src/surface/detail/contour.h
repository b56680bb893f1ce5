#pragma once

#include "surface/extract_surface.h"

namespace trocar::detail {

/// Contour of a mask, smoothed and decimated with VTK's filters; in mm along the grid's axes from voxel (0,0,0),
/// closed, triangles outward.
TriangleMesh contour(const MaskGrid& mask, const SurfaceOptions& options);

/// Moves all vertices along their normals by one distance, at most `max_shift_mm`, so that the mesh encloses the
/// volume again that rounding off its corners took.
void restore_volume(TriangleMesh& mesh, double volume_mm3, double max_shift_mm);

}  // namespace trocar::detail
