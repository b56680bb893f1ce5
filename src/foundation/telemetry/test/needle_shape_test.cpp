#include "telemetry/needle_shape.h"

#include <gtest/gtest.h>

namespace trocar::telemetry {
namespace {

NeedleShape bent_by(double tip_mm, std::uint8_t spans) {
  NeedleShape shape;
  shape.spans = spans;
  for (std::size_t i = 0; i < spans; ++i)
    shape.beside_mm[i][1] = static_cast<float>(tip_mm * static_cast<double>(i + 1) / spans);
  return shape;
}

TEST(NeedleShape, IsStraightWithoutPoints) {
  const Pose X_PN = needle_pose({1.0, 2.0, 3.0}, Vec3::UnitX());
  const std::vector<Vec3> points_P = shaft_points({}, X_PN, 150.0);
  ASSERT_EQ(points_P.size(), 2u);
  EXPECT_NEAR((points_P[0] - Vec3(-149.0, 2.0, 3.0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(points_P[1], X_PN.p());
}

TEST(NeedleShape, SpansKeepTheirLength) {
  for (const double tip_mm : {0.0, 3.0, 40.0}) {
    const std::vector<Vec3> points_P = shaft_points(bent_by(tip_mm, 17), Pose(), 150.0);
    ASSERT_EQ(points_P.size(), 18u);
    for (std::size_t i = 1; i < points_P.size(); ++i)
      EXPECT_NEAR((points_P[i] - points_P[i - 1]).norm(), 150.0 / 17.0, 1e-9) << tip_mm;
    EXPECT_NEAR(points_P.back().y(), tip_mm, 1e-5);
    EXPECT_NEAR(points_P.back().z(), -150.0 + std::sqrt(150.0 * 150.0 - tip_mm * tip_mm), 1e-4);
  }
}

TEST(NeedleShape, ComparesToTheLastPointOfEither) {
  EXPECT_EQ(largest_difference_mm({}, {}), 0.0);
  EXPECT_NEAR(largest_difference_mm({}, bent_by(2.0, 17)), 2.0, 1e-6);
  EXPECT_NEAR(largest_difference_mm(bent_by(2.0, 17), {}), 2.0, 1e-6);
  EXPECT_NEAR(largest_difference_mm(bent_by(2.0, 17), bent_by(-1.0, 17)), 3.0, 1e-6);
}

TEST(NeedleShape, TooManySpansAreNotRead) {
  NeedleShape forged;
  forged.spans = 255;
  EXPECT_EQ(shaft_points(forged, Pose(), 150.0).size(), NeedleShape::kMostSpans + 1);
  EXPECT_EQ(largest_difference_mm(forged, {}), 0.0);
}

}  // namespace
}  // namespace trocar::telemetry
