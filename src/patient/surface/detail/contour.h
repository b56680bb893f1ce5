#pragma once

#include "geometry/shapes.h"
#include "surface/extract_surface.h"

namespace trocar::surface::detail {

/// Fill level of each voxel by a mask, 0..255, on a grid made coarser by whole factors until its spacing is about
/// `spacing_mm` (0: the mask's own grid).
volume::Grid<std::uint8_t> occupancy(const volume::MaskGrid& mask, double spacing_mm);

/// Faces between voxels that are half filled or more and others, the grid's border included: a contour has about two
/// triangles for each.
std::size_t count_faces(const volume::Grid<std::uint8_t>& occupancy);

/// The occupancy at about `spacing_mm`, or on a coarser grid: with at most `wanted_faces` unless that loses thin walls,
/// and with at most `max_faces` in any case. Smoothing and decimation take minutes for the millions of triangles of
/// noise.
volume::Grid<std::uint8_t> bounded_occupancy(const volume::MaskGrid& mask, double spacing_mm, std::size_t wanted_faces,
                                             std::size_t max_faces);

/// Contour of a half filled voxel, smoothed and decimated with VTK's filters; in mm along the grid's axes from voxel
/// (0,0,0), closed, triangles outward.
TriangleMesh contour(const volume::Grid<std::uint8_t>& occupancy, const SurfaceOptions& options);

/// Fills the holes of a mesh, each by a fan of triangles: afterwards every edge is walked as often in one direction as
/// in the other. For the few triangles that a decimation loses.
void close_holes(TriangleMesh& mesh);

/// Moves all vertices along their normals by one distance, at most `max_shift_mm`, to restore the enclosed volume that
/// was lost when its corners were rounded off.
void restore_volume(TriangleMesh& mesh, double volume_mm3, double max_shift_mm);

}  // namespace trocar::surface::detail
