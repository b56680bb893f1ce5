#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace trocar::scene::detail {

/// Unit normals of the vertices: mean of the adjacent triangles' normals, weighted by area; zero without a triangle.
std::vector<Vec3f> vertex_normals(const TriangleMesh& mesh);

struct SimplifiedMesh {
  TriangleMesh mesh;
  std::vector<Vec3f> normals;  ///< Unit vectors, one per vertex.
};

/// A mesh with fewer triangles, for drawing during motion: vertices in one cell of a lattice become their mean,
/// triangles that collapse to an edge are dropped. The cells are `coarseness` times as wide as the mean edge: 2 leaves
/// about a fifth of the triangles, 4 about a twentieth. Normals are means of `normals` (one per vertex of `mesh`), so
/// that its shading is that of the fine mesh. Linear in the mesh's size.
SimplifiedMesh simplify(const TriangleMesh& mesh, const std::vector<Vec3f>& normals, double coarseness);

/// About `keep` (0..1) of a mesh's triangles by edge collapses with the least change of shape (VTK's quadric
/// decimation), with normals computed from the new mesh. Slower than `simplify`, but better for a small `keep`.
SimplifiedMesh decimate(const TriangleMesh& mesh, double keep);

}  // namespace trocar::scene::detail
