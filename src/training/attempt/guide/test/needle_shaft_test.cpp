#include <gtest/gtest.h>

#include <cmath>

#include "attempt/guide/needle_view.h"
#include "geometry/pose.h"
#include "telemetry/testing/sample_at.h"

namespace trocar::attempt {
namespace {

using testing::sample_at;

constexpr double kLength_mm = 150.0;

double length_of(const std::vector<Vec3>& points) {
  double length_mm = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length_mm += (points[i] - points[i - 1]).norm();
  return length_mm;
}

const Pose kHeld = needle_pose({10.0, 20.0, 30.0}, Vec3(0.3, 1.0, -0.2).normalized());

TEST(NeedleShaft, OutsidePartIsTheRestOfItsLength) {
  const std::vector<Vec3> shaft_P{Vec3(0, 0, 0), Vec3(0, 0, 100), Vec3(0, 30, 140)};
  EXPECT_EQ(shaft_outside(shaft_P, 0.0), shaft_P);
  const std::vector<Vec3> bent_P = shaft_outside(shaft_P, 25.0);
  ASSERT_EQ(bent_P.size(), 3u);
  EXPECT_NEAR((bent_P.back() - Vec3(0, 15, 120)).norm(), 0.0, 1e-9);
  const std::vector<Vec3> straight_P = shaft_outside(shaft_P, 90.0);
  ASSERT_EQ(straight_P.size(), 2u);
  EXPECT_NEAR((straight_P.back() - Vec3(0, 0, 60)).norm(), 0.0, 1e-9);
  EXPECT_TRUE(shaft_outside(shaft_P, 150.0).empty());
}

TEST(NeedleShaft, IsStraightFromHubToTipWhenUnbent) {
  const std::vector<Vec3> shaft = needle_shaft(sample_at(kHeld), {}, kLength_mm);
  ASSERT_EQ(shaft.size(), 2u);
  EXPECT_EQ(shaft.back(), kHeld.p());
  EXPECT_NEAR((shaft.front() - (kHeld.p() - kLength_mm * kHeld.R().col(2))).norm(), 0.0, 1e-9);
}

TEST(NeedleShaft, KeepsItsLengthWhenTheTipLags) {
  telemetry::TickSample sample = sample_at(kHeld);
  sample.tip_mm -= 5.0 * sample.axis;
  const std::vector<Vec3> shaft = needle_shaft(sample, {}, kLength_mm);
  EXPECT_NEAR(length_of(shaft), kLength_mm, 1e-9);
  EXPECT_EQ(shaft.back(), sample.tip_mm);
}

TEST(NeedleShaft, MatchesTheShapeAndTipOfTheTick) {
  telemetry::TickSample sample = sample_at(kHeld);
  const Vec3 aside = kHeld.R().col(0);
  sample.tip_mm += 6.0 * aside - 3.0 * sample.axis;
  telemetry::NeedleShape shape;
  shape.spans = 10;
  for (std::size_t i = 0; i < 10; ++i)  // a parabola: clamped in the grip, 6 mm aside at the tip
    shape.beside_mm[i][0] = static_cast<float>(6.0 * std::pow((static_cast<double>(i) + 1.0) / 10.0, 2.0));
  const std::vector<Vec3> shaft = needle_shaft(sample, shape, kLength_mm);
  ASSERT_EQ(shaft.size(), 11u);
  EXPECT_EQ(shaft.back(), sample.tip_mm);
  EXPECT_NEAR(length_of(shaft), kLength_mm, 1e-9);
  const Vec3 hub_lag = shaft.front() - (kHeld.p() - kLength_mm * kHeld.R().col(2));
  EXPECT_NEAR(hub_lag.dot(aside), 0.0, 1e-6) << "the hub stays on the grip's axis";
  EXPECT_NEAR(hub_lag.dot(kHeld.R().col(2)), -3.0, 0.2) << "it lags with the tip, and the bent shaft is shorter";
  const Vec3 first = (shaft[1] - shaft[0]).normalized();
  EXPECT_LT(angle_between_rad(first, kHeld.R().col(2)), 0.005);
  EXPECT_NEAR((shaft[5] - shaft[0]).dot(aside), 1.5, 1e-6);
}

}  // namespace
}  // namespace trocar::attempt
