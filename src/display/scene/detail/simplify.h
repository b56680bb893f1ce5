#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace trocar::scene::detail {

/// Unit normals of the vertices, of the triangles around weighted by area; zero where no triangle is.
std::vector<Vec3f> vertex_normals(const TriangleMesh& mesh);

struct SimplifiedMesh {
  TriangleMesh mesh;
  std::vector<Vec3f> normals;  ///< Unit, one a vertex.
};

/// A mesh with fewer triangles, for what moves: vertices in one cell of a lattice become their mean, triangles that
/// shrink to an edge are dropped. The cells are `coarseness` times as wide as the mean edge: 2 leaves about a fifth of
/// the triangles, 4 about a twentieth. Normals are means of those given, one a vertex of the mesh, so that the light
/// plays on it as on the fine mesh. Linear in the mesh's size.
SimplifiedMesh simplify(const TriangleMesh& mesh, const std::vector<Vec3f>& normals, double coarseness);

/// About `keep` (0..1) of a mesh's triangles by collapsing edges where that changes the shape least (VTK's quadric
/// decimation), with the new mesh's own normals. Slow beside `simplify`, and better where little is kept.
SimplifiedMesh decimate(const TriangleMesh& mesh, double keep);

}  // namespace trocar::scene::detail
