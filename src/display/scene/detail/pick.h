#pragma once

#include <optional>

#include "geometry/triangle_mesh.h"

namespace trocar::scene::detail {

/// Distance (mm) from `origin` to the first triangle that a ray along the unit vector `direction` meets, from whichever
/// side; nothing where it meets none.
std::optional<double> first_hit_mm(const TriangleMesh& mesh, const Vec3& origin, const Vec3& direction);

}  // namespace trocar::scene::detail
