#pragma once

#include "geometry/triangle_mesh.h"

namespace trocar::surface::detail {

/// Fills the holes of a mesh, each by a fan of triangles: afterwards every edge is walked as often in one direction as
/// in the other. For the few triangles that a decimation loses.
void close_holes(TriangleMesh& mesh);

/// Moves all vertices along their normals by one distance, at most `max_shift_mm`, to restore the enclosed volume that
/// was lost when its corners were rounded off.
void restore_volume(TriangleMesh& mesh, double volume_mm3, double max_shift_mm);

}  // namespace trocar::surface::detail
