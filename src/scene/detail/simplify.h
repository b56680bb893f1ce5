#pragma once

#include "geometry/triangle_mesh.h"

namespace trocar::detail {

/// A mesh with fewer triangles, for what moves: vertices in one cell of a lattice become their mean, triangles that
/// shrink to an edge are dropped. The cells are `coarseness` times as wide as the mean edge: 2 leaves about a fifth of
/// the triangles, 4 about a twentieth. Linear in the mesh's size; a closed mesh stays closed.
TriangleMesh simplify(const TriangleMesh& mesh, double coarseness);

/// Unit normals of the vertices, of the triangles around weighted by area; zero where no triangle is.
std::vector<Vec3f> vertex_normals(const TriangleMesh& mesh);

}  // namespace trocar::detail
