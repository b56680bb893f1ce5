#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/pose.h"
#include "geometry/shapes.h"

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

/// Distance (mm) from `origin` to the first triangle that a ray along the unit vector `direction` intersects, from
/// either side; empty if there is none.
std::optional<double> first_hit_mm(const TriangleMesh& mesh, const Vec3& origin, const Vec3& direction);

/// A circle of a solid of revolution: at `z` along the axis, of radius `r` (mm).
struct Ring {
  double z;
  double r;
};

/// Solid of revolution about the z axis of L: rings by rising z; closed by discs at both ends.
TriangleMesh make_turned(const Pose& X_AL, std::span<const Ring> rings, int sides = 24);
/// A box about the origin of L with half sizes, its edges along z rounded.
TriangleMesh make_box(const Pose& X_AL, const Vec3& half_mm, double corner_mm = 0.0);

/// Surface through closed rings with equal numbers of points, closed at both ends by fans to the rings' centres. The
/// points of a ring are counter-clockwise as seen from the last ring's side.
TriangleMesh make_loft(const std::vector<std::vector<Vec3>>& rings);

}  // namespace trocar::scene::detail
