#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "telemetry/tick_sample.h"

namespace trocar::testing {
namespace {

TEST(ToolPose, RoundTripsAPose) {
  const Mat3 R = Eigen::AngleAxisd(2.5, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  const Pose X(R, {12.0, -400.5, 1e3});
  const Pose back = telemetry::to_tool_pose(X).pose();
  EXPECT_LT((back.R() - R).norm(), 1e-15 * 10);  // a few roundings of numbers below 1
  EXPECT_EQ(back.p(), X.p());
}

TEST(ToolPose, RefusesInvalidPoses) {
  telemetry::ToolPose pose;
  EXPECT_TRUE(pose.is_valid());
  pose.rotation_wxyz = {0, 0, 0, 0};
  EXPECT_FALSE(pose.is_valid());
  pose.rotation_wxyz = {2, 0, 0, 0};
  EXPECT_FALSE(pose.is_valid());
  pose.rotation_wxyz = {std::numeric_limits<double>::quiet_NaN(), 0, 0, 0};
  EXPECT_FALSE(pose.is_valid());
  pose = {};
  pose.p_mm.x() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(pose.is_valid());
}

}  // namespace
}  // namespace trocar::testing
