#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "attempt/tools/tool_motion.h"

namespace trocar::attempt {
namespace {

constexpr double kFrame_s = 1.0 / 60.0, kTick_s = 0.001;

TEST(MovedTowards, IsLimitedInDistanceAndAngle) {
  const Pose from;
  const Pose to(Eigen::AngleAxisd(1.0, Vec3::UnitX()).toRotationMatrix(), Vec3(30.0, 0.0, 40.0));
  const Pose on_the_way = moved_towards(from, to, 5.0, 0.25);
  EXPECT_NEAR((on_the_way.p() - Vec3(3.0, 0.0, 4.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((turn_between(from.R(), on_the_way.R()) - Vec3(0.25, 0.0, 0.0)).norm(), 0.0, 1e-12);
  const Pose there = moved_towards(from, to, 1e3, 10.0);
  EXPECT_NEAR((there.p() - to.p()).norm() + (there.R() - to.R()).norm(), 0.0, 1e-12);
}

TEST(MovedTowards, StaysForANonFinitePose) {
  const Pose from = Pose::translation({1.0, 2.0, 3.0});
  const Pose nowhere = Pose::translation(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(moved_towards(from, nowhere, 1.0, 1.0).p(), from.p());
}

TEST(TurnBetween, IsTheInverseOfMoved) {
  for (const double angle : {1e-9, 0.3, 2.0, std::numbers::pi - 1e-3}) {
    const Vec3 turn = angle * Vec3(1.0, -2.0, 0.5).normalized();
    EXPECT_NEAR((turn_between(Mat3::Identity(), moved({}, Vec3::Zero(), turn).R()) - turn).norm(), 0.0, 1e-9) << angle;
  }
}

TEST(LedPose, LimitsTheSpeedOfAPointerJump) {
  const SpeedLimits limits;
  LedPose hand(limits);
  hand.put({});
  hand.lead(Pose(Eigen::AngleAxisd(2.0, Vec3::UnitZ()).toRotationMatrix(), Vec3(200.0, 0.0, 0.0)), Vec3::Zero(),
            Vec3::Zero());
  Pose before = hand.X_P();
  for (int i = 0; i < 2000; ++i) {
    hand.step(kTick_s);
    ASSERT_LE((hand.X_P().p() - before.p()).norm(), limits.most_mm_per_s * kTick_s + 1e-12);
    ASSERT_LE(turn_between(before.R(), hand.X_P().R()).norm(), limits.most_rad_per_s * kTick_s + 1e-9);
    before = hand.X_P();
  }
  EXPECT_NEAR(hand.X_P().p().x(), 2.0 * limits.most_mm_per_s, 0.1);
}

TEST(LedPose, SmoothsMotionBetweenFrames) {
  constexpr double kSpeed_mm_s = 10.0;
  LedPose hand;
  hand.put({});
  double slowest = kSpeed_mm_s, fastest = kSpeed_mm_s;
  for (int frame = 0; frame < 120; ++frame) {
    hand.lead(Pose::translation({kSpeed_mm_s * kFrame_s * frame, 0.0, 0.0}), {kSpeed_mm_s, 0.0, 0.0}, Vec3::Zero());
    for (int i = 0; i < 16; ++i) {
      hand.step(kFrame_s / 16.0);
      if (frame < 30) continue;  // has come up to speed
      slowest = std::min(slowest, hand.v_P().x());
      fastest = std::max(fastest, hand.v_P().x());
    }
  }
  EXPECT_GT(slowest, 0.9 * kSpeed_mm_s);
  EXPECT_LT(fastest, 1.1 * kSpeed_mm_s);
}

TEST(LedPose, StopsWithoutNewTargets) {
  LedPose hand;
  hand.put({});
  hand.lead({}, {40.0, 0.0, 0.0}, Vec3::Zero());
  for (int i = 0; i < 2000; ++i) hand.step(kTick_s);
  EXPECT_NEAR(hand.X_P().p().x(), 40.0 * LedPose::kStandsStill_s, 1e-3);
  EXPECT_NEAR(hand.v_P().norm(), 0.0, 1e-6);
}

TEST(LedPose, StaysWhileClamped) {
  LedPose hand;
  hand.put({});
  hand.lead(Pose::translation({50.0, 0.0, 0.0}), Vec3::Zero(), Vec3::Zero());
  hand.step(kTick_s);
  hand.clamp(true);
  const Vec3 held = hand.X_P().p();
  hand.lead(Pose::translation({-50.0, 0.0, 0.0}), Vec3::Zero(), Vec3::Zero());
  for (int i = 0; i < 500; ++i) hand.step(kTick_s);
  EXPECT_EQ(hand.X_P().p(), held);
  EXPECT_EQ(hand.v_P(), Vec3::Zero());
}

TEST(LedPose, IgnoresNonFiniteTargets) {
  LedPose hand;
  hand.put({});
  hand.lead(Pose::translation(Vec3::Constant(std::numeric_limits<double>::infinity())), Vec3::Zero(), Vec3::Zero());
  hand.step(kTick_s);
  hand.step(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(hand.X_P().p(), Vec3::Zero());
}

}  // namespace
}  // namespace trocar::attempt
