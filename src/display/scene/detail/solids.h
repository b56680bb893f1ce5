#pragma once

#include <span>
#include <vector>

#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"

namespace trocar::scene::detail {

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
