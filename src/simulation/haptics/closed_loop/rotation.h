#pragma once

#include "geometry/vec.h"

namespace trocar::haptics {

/// Axis times angle (rad, 0..pi) of a rotation. Real-time safe.
Vec3 rotation_vector(const Mat3& R) noexcept;
/// The rotation by |v| rad about v; zero gives identity. Real-time safe.
Mat3 rotation_from_vector(const Vec3& v) noexcept;

}  // namespace trocar::haptics
