#include <gtest/gtest.h>

#include "telemetry/testing/sample_at.h"
#include "telemetry/tick_sample.h"

namespace trocar::telemetry {
namespace {

using testing::sample_at;

const Pose kHeld = needle_pose({10.0, 20.0, 30.0}, Vec3(0.3, 1.0, -0.2).normalized());

TEST(FeltNeedle, RotatesTheDevicePoseToTheFeltAxis) {
  TickSample sample = sample_at(kHeld);
  sample.axis = (sample.axis + 0.2 * sample.axis.unitOrthogonal()).normalized();
  sample.tip_mm += Vec3(1.0, 0.0, 0.0);
  const Pose felt = felt_needle(sample);
  EXPECT_NEAR((felt.R().col(2) - sample.axis).norm(), 0.0, 1e-12);
  EXPECT_EQ(felt.p(), sample.tip_mm);
  EXPECT_NEAR((device_pose(sample).R() - kHeld.R()).norm(), 0.0, 1e-12);
}

TickSample inserted(InsertionPhase phase) {
  TickSample sample = sample_at(kHeld);
  sample.phase = phase;
  sample.axis = Vec3::UnitY();
  sample.tip_mm = {1.0, 25.0, 3.0};
  sample.device_mm = {4.0, 27.0, 3.0};  // the grip has swung, too
  sample.depth_mm = 30.0;
  return sample;
}

TEST(NeedlePlace, IsInTheChannelForAnyGripAngle) {
  for (const InsertionPhase phase : {InsertionPhase::kInserted, InsertionPhase::kRetracting}) {
    const NeedlePlace place = needle_place(inserted(phase));
    EXPECT_NEAR((place.X_PN.R().col(2) - Vec3::UnitY()).norm(), 0.0, 1e-12);
    EXPECT_NEAR((place.X_PN.p() - Vec3(1.0, 25.0, 3.0)).norm(), 0.0, 1e-12);
    EXPECT_NEAR(place.pressed_mm, 2.0, 1e-12);
  }
}

TEST(NeedlePlace, PullsBackATipThatPressesOnALayer) {
  TickSample sample = inserted(InsertionPhase::kLoading);
  sample.layer_displacement_mm = 0.7;
  const NeedlePlace place = needle_place(sample);
  EXPECT_LT(place.X_PN.p().y(), 25.0 - 0.7);
  EXPECT_GT(place.X_PN.p().y(), 25.0 - 1.0);
  EXPECT_NEAR(place.pressed_mm, 2.0, 1e-12);
  sample.depth_mm = 0.7;  // unpierced skin
  const NeedlePlace outside = needle_place(sample);
  EXPECT_LT(outside.X_PN.p().y(), sample.tip_mm.y() - 0.7);
  EXPECT_EQ(outside.pressed_mm, 0.0);
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
