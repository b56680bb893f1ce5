#include "telemetry/tool_pose.h"

#include <cmath>

namespace trocar::telemetry {
namespace {

Eigen::Quaterniond quaternion(const std::array<double, 4>& wxyz) noexcept {
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

}  // namespace

bool ToolPose::is_valid() const noexcept {
  constexpr double kRounding = 1e-6;
  return p_mm.allFinite() && std::abs(quaternion(rotation_wxyz).norm() - 1.0) < kRounding;
}

Pose ToolPose::pose() const noexcept {
  return {quaternion(rotation_wxyz).toRotationMatrix(), p_mm};
}

ToolPose to_tool_pose(const Pose& X_PTool) noexcept {
  const Eigen::Quaterniond q = Eigen::Quaterniond(X_PTool.R()).normalized();
  return {{q.w(), q.x(), q.y(), q.z()}, X_PTool.p()};
}

}  // namespace trocar::telemetry
