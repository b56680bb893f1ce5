#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>

namespace trocar {
inline namespace geometry {

using Vec3 = Eigen::Vector3d;   ///< Point (mm), direction, force (N) or torque (N mm); the name states frame and kind.
using Vec3f = Eigen::Vector3f;  ///< The same in bulk data (meshes).
using Mat3 = Eigen::Matrix3d;

/// N zero vectors. `std::array<Vec3, N> x{}` is not zero: Eigen does not initialise its components.
template <std::size_t N>
std::array<Vec3, N> zero_vectors() noexcept {
  std::array<Vec3, N> vectors;
  vectors.fill(Vec3::Zero());
  return vectors;
}

}  // namespace geometry
}  // namespace trocar
