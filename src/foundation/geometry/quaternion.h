#pragma once

#include <array>

#include "geometry/vec.h"

namespace trocar {
inline namespace geometry {

/// The components of a quaternion in the order w, x, y, z, as in stored records. Real-time safe.
inline std::array<double, 4> to_wxyz(const Eigen::Quaterniond& q) noexcept {
  return {q.w(), q.x(), q.y(), q.z()};
}

/// The quaternion of stored components; not normalised. Real-time safe.
inline Eigen::Quaterniond from_wxyz(const std::array<double, 4>& wxyz) noexcept {
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

}  // namespace geometry
}  // namespace trocar
