#include "telemetry/tool_pose.h"

#include <cmath>

#include "geometry/quaternion.h"

namespace trocar::telemetry {

bool ToolPose::is_valid() const noexcept {
  constexpr double kRounding = 1e-6;
  return p_mm.allFinite() && std::abs(from_wxyz(rotation_wxyz).norm() - 1.0) < kRounding;
}

Pose ToolPose::pose() const noexcept {
  return {from_wxyz(rotation_wxyz).toRotationMatrix(), p_mm};
}

ToolPose to_tool_pose(const Pose& X_PTool) noexcept {
  return {to_wxyz(Eigen::Quaterniond(X_PTool.R()).normalized()), X_PTool.p()};
}

}  // namespace trocar::telemetry
