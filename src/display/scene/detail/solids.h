#pragma once

#include <span>
#include <vector>

#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"

namespace trocar::scene::detail {

/// A circle of a turned solid: at `z` along the axis, of radius `r` (mm).
struct Ring {
  double z;
  double r;
};

/// Turned on a lathe about the z axis of A: rings by rising z; closed by discs at both ends.
TriangleMesh make_turned(const Pose& X_AL, std::span<const Ring> rings, int sides = 24);
/// A box about the origin of L with half sizes, its edges along z rounded.
TriangleMesh make_box(const Pose& X_AL, const Vec3& half_mm, double corner_mm = 0.0);

/// Closed rings of equally many points, each counter-clockwise seen from the last one's side, joined to a skin and
/// closed at both ends by fans to the rings' middles.
TriangleMesh make_loft(const std::vector<std::vector<Vec3>>& rings);

}  // namespace trocar::scene::detail
