#pragma once

#include <optional>

#include "geometry/triangle_mesh.h"

namespace trocar::scene::detail {

/// Distance (mm) from `origin` to the first triangle that a ray along the unit vector `direction` intersects, from
/// either side; empty if there is none.
std::optional<double> first_hit_mm(const TriangleMesh& mesh, const Vec3& origin, const Vec3& direction);

}  // namespace trocar::scene::detail
