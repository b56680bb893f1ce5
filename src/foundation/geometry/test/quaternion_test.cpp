#include <gtest/gtest.h>

#include <cmath>

#include "geometry/pose.h"

namespace trocar {
inline namespace geometry {
namespace {

TEST(Quaternion, IsStoredWithTheScalarFirst) {
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(3.0, Vec3::UnitX()));
  const std::array<double, 4> wxyz = to_wxyz(turned);
  EXPECT_DOUBLE_EQ(wxyz[0], std::cos(1.5));
  EXPECT_DOUBLE_EQ(wxyz[1], std::sin(1.5));
  EXPECT_EQ(wxyz[2], 0.0);
  EXPECT_EQ(wxyz[3], 0.0);
}

TEST(Quaternion, RoundTripsBitwise) {
  const std::array<double, 4> wxyz{0.1, -0.7, 3e-9, 12.0};
  EXPECT_EQ(to_wxyz(from_wxyz(wxyz)), wxyz);
}

}  // namespace
}  // namespace geometry
}  // namespace trocar
