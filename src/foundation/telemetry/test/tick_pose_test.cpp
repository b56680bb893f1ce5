#include "telemetry/tick_pose.h"

#include <gtest/gtest.h>

#include "telemetry/testing/sample_at.h"

namespace trocar::telemetry {
namespace {

using testing::sample_at;

const Pose kHeld = needle_pose({10.0, 20.0, 30.0}, Vec3(0.3, 1.0, -0.2).normalized());

TEST(FeltNeedle, TurnsTheDevicesPoseToTheFeltAxis) {
  TickSample sample = sample_at(kHeld);
  sample.axis = (sample.axis + 0.2 * sample.axis.unitOrthogonal()).normalized();
  sample.tip_mm += Vec3(1.0, 0.0, 0.0);
  const Pose felt = felt_needle(sample);
  EXPECT_NEAR((felt.R().col(2) - sample.axis).norm(), 0.0, 1e-12);
  EXPECT_EQ(felt.p(), sample.tip_mm);
  EXPECT_NEAR((device_pose(sample).R() - kHeld.R()).norm(), 0.0, 1e-12);
}

TEST(FeltProbe, HasItsAxisInY) {
  TickSample sample = sample_at(Pose());
  sample.axis = Vec3(0.0, 1.0, 0.1).normalized();
  EXPECT_NEAR((felt_probe(sample).R().col(1) - sample.axis).norm(), 0.0, 1e-12);
}

TEST(DevicePose, IsUnturnedWithoutARotation) {
  TickSample sample = sample_at(kHeld);
  sample.device_rotation_wxyz = {};
  EXPECT_EQ(device_pose(sample).R(), Mat3::Identity());
  EXPECT_EQ(device_pose(sample).p(), kHeld.p());
}

}  // namespace
}  // namespace trocar::telemetry
