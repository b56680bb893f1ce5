#pragma once

#include "geometry/vec.h"

namespace trocar {
inline namespace geometry {

/// Scales `v` to the length `most` if it is longer, and returns whether it was longer. A vector that contains NaN is
/// not changed. Real-time safe.
inline bool clamp_norm(Vec3& v, double most) noexcept {
  const double norm = v.norm();
  if (!(norm > most)) return false;
  v *= most / norm;
  return true;
}

/// `v`, scaled to the length `most` if it is longer. Real-time safe.
inline Vec3 clamped_norm(Vec3 v, double most) noexcept {
  clamp_norm(v, most);
  return v;
}

}  // namespace geometry
}  // namespace trocar
