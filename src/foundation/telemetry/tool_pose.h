#pragma once

#include <array>

#include "geometry/pose.h"

namespace trocar::telemetry {

/// Pose of a tool in P, X_PN or X_PT, as a tick takes it and its record keeps it. The rotation is a quaternion, because
/// a rotation matrix that is stored as a quaternion does not come back to the same bits: a replay of recorded tool
/// poses does.
struct ToolPose {
  std::array<double, 4> rotation_wxyz{1, 0, 0, 0};  ///< Unit quaternion.
  Vec3 p_mm = Vec3::Zero();

  /// Finite, and its quaternion of length 1.
  bool is_valid() const noexcept;
  Pose pose() const noexcept;
};

ToolPose to_tool_pose(const Pose& X_PTool) noexcept;

}  // namespace trocar::telemetry
