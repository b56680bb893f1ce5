#pragma once

#include <array>

#include "geometry/pose.h"

namespace trocar::telemetry {

/// Pose of a tool in P, X_PN or X_PT, as the input of a tick and in its record. The rotation is a quaternion: a
/// rotation matrix that is stored as a quaternion is not restored bit-identically, whereas a replay of recorded tool
/// poses is bit-identical.
struct ToolPose {
  std::array<double, 4> rotation_wxyz{1, 0, 0, 0};  ///< Unit quaternion.
  Vec3 p_mm = Vec3::Zero();

  /// True if all numbers are finite and the quaternion has length 1.
  bool is_valid() const noexcept;
  Pose pose() const noexcept;
};

ToolPose to_tool_pose(const Pose& X_PTool) noexcept;

}  // namespace trocar::telemetry
