#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "geometry/shapes.h"

namespace trocar {
inline namespace geometry {
namespace {

TEST(Segment, ComputesLengthDirectionAndPoints) {
  const Segment segment{{1, 2, 3}, {1, 2, 13}};
  EXPECT_DOUBLE_EQ(segment.length_mm(), 10.0);
  EXPECT_EQ(segment.direction(), Vec3(0, 0, 1));
  EXPECT_EQ(segment.at(0.25), Vec3(1, 2, 5.5));
}

TEST(Segment, ClosestPointIsClampedToTheEnds) {
  const Segment segment{{0, 0, 0}, {10, 0, 0}};
  EXPECT_DOUBLE_EQ(closest_fraction(segment, {3, 4, 0}), 0.3);
  EXPECT_DOUBLE_EQ(distance_mm(segment, {3, 4, 0}), 4.0);
  EXPECT_EQ(closest_fraction(segment, {-3, 4, 0}), 0.0);
  EXPECT_DOUBLE_EQ(distance_mm(segment, {-3, 4, 0}), 5.0);
  EXPECT_EQ(closest_fraction(segment, {13, 0, 4}), 1.0);
  EXPECT_DOUBLE_EQ(distance_mm(segment, {13, 0, 4}), 5.0);
}

TEST(Segment, ActsAsAPointWithoutLength) {
  const Segment point{{1, 1, 1}, {1, 1, 1}};
  EXPECT_EQ(closest_fraction(point, {4, 5, 1}), 0.0);
  EXPECT_DOUBLE_EQ(distance_mm(point, {4, 5, 1}), 5.0);
}

TEST(Segment, ClosestPointHasTheSmallestDistance) {
  Random random(1);
  const auto coordinate = [&] { return random.uniform(-10.0, 10.0); };
  for (int n = 0; n < 200; ++n) {
    const Segment segment{{coordinate(), coordinate(), coordinate()}, {coordinate(), coordinate(), coordinate()}};
    const Vec3 q(coordinate(), coordinate(), coordinate());
    const double closest_mm = distance_mm(segment, q);
    for (int s = 0; s <= 100; ++s) EXPECT_GE((q - segment.at(s / 100.0)).norm(), closest_mm - 1e-12);
  }
}

TEST(DistanceToLine, IsTheLengthOfThePerpendicular) {
  EXPECT_DOUBLE_EQ(distance_to_line_mm({0, 0, 5}, {0, 0, 1}, {3, 4, -100}), 5.0);
  EXPECT_DOUBLE_EQ(distance_to_line_mm({1, 1, 1}, Vec3(1, 1, 0).normalized(), {1, 1, 1}), 0.0);
  EXPECT_NEAR(distance_to_line_mm({0, 0, 0}, Vec3(1, 1, 0).normalized(), {1, 0, 0}), std::sqrt(0.5), 1e-15);
}

}  // namespace
}  // namespace geometry
}  // namespace trocar
