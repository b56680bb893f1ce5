#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace trocar {

using Vec3 = Eigen::Vector3d;   ///< Point (mm), direction, force (N) or torque (N mm); the name tells frame and kind.
using Vec3f = Eigen::Vector3f;  ///< The same in bulk data (meshes).
using Mat3 = Eigen::Matrix3d;

}  // namespace trocar
