#include "geometry/pose.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "core/random.h"

namespace trocar {
inline namespace geometry {
namespace {

constexpr double kTiny = 1e-12;

Vec3 random_vec(Random& random) {
  const double x = random.normal();
  const double y = random.normal();
  return {x, y, random.normal()};
}

Pose random_pose(Random& random) {
  const Vec3 axis = random_vec(random).normalized();
  return {Eigen::AngleAxisd(random.uniform(-3.0, 3.0), axis).toRotationMatrix(), 100.0 * random_vec(random)};
}

void expect_rotation(const Mat3& R) {
  EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), kTiny);
  EXPECT_NEAR(R.determinant(), 1.0, kTiny);
}

TEST(Pose, MapsPointsByRotationThenTranslation) {
  Mat3 R_AB;
  R_AB << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // a quarter turn about z
  const Pose X_AB(R_AB, {10, 20, 30});
  EXPECT_LT((X_AB * Vec3(1, 2, 3) - Vec3(8, 21, 33)).norm(), kTiny);
  EXPECT_EQ(Pose::translation({1, 2, 3}) * Vec3(1, 1, 1), Vec3(2, 3, 4));
  EXPECT_EQ(Pose() * Vec3(1, 2, 3), Vec3(1, 2, 3));
}

TEST(Pose, CompositionMapsLikeSuccessivePoses) {
  Random random(1);
  for (int n = 0; n < 50; ++n) {
    const Pose X_AB = random_pose(random);
    const Pose X_BC = random_pose(random);
    const Vec3 p_C = random_vec(random);
    EXPECT_LT(((X_AB * X_BC) * p_C - X_AB * (X_BC * p_C)).norm(), 1e-10);
    expect_rotation((X_AB * X_BC).R());
  }
}

TEST(Pose, InverseUndoesThePose) {
  Random random(2);
  for (int n = 0; n < 50; ++n) {
    const Pose X_AB = random_pose(random);
    const Vec3 p_B = random_vec(random);
    EXPECT_LT((X_AB.inverse() * (X_AB * p_B) - p_B).norm(), 1e-10);
    EXPECT_LT((X_AB * X_AB.inverse()).p().norm(), 1e-10);
  }
}

TEST(Pose, DetectsNonFiniteValues) {
  EXPECT_TRUE(Pose().is_finite());
  EXPECT_FALSE(Pose::translation({0, std::numeric_limits<double>::infinity(), 0}).is_finite());
  EXPECT_FALSE(Pose(Mat3::Constant(std::numeric_limits<double>::quiet_NaN()), Vec3::Zero()).is_finite());
}

TEST(RotationBetween, RotatesByTheSmallestAngle) {
  Random random(3);
  for (int n = 0; n < 100; ++n) {
    const Vec3 from = random_vec(random).normalized();
    const Vec3 to = random_vec(random).normalized();
    const Mat3 R = rotation_between(from, to);
    expect_rotation(R);
    EXPECT_LT((R * from - to).norm(), kTiny);
    EXPECT_NEAR(Eigen::AngleAxisd(R).angle(), angle_between_rad(from, to), 1e-9);
  }
}

TEST(RotationBetween, HandlesEqualAndOppositeDirections) {
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(Vec3(1, -2, 3).normalized())}) {
    EXPECT_LT((rotation_between(axis, axis) - Mat3::Identity()).norm(), kTiny);
    const Mat3 half_turn = rotation_between(axis, -axis);
    expect_rotation(half_turn);
    EXPECT_LT((half_turn * axis + axis).norm(), 1e-9);
  }
}

TEST(NeedlePose, PutsTheTipAtTheOriginAndTheAxisAlongZ) {
  Random random(4);
  for (int n = 0; n < 50; ++n) {
    const Vec3 tip_A = 100.0 * random_vec(random);
    const Vec3 axis_A = random_vec(random);  // need not be of unit length
    const Pose X_AN = needle_pose(tip_A, axis_A);
    expect_rotation(X_AN.R());
    EXPECT_EQ(X_AN.p(), tip_A);
    const Vec3 hub_A = X_AN * Vec3(0, 0, -150.0);
    EXPECT_LT((tip_A - hub_A - 150.0 * axis_A.normalized()).norm(), 1e-9);
  }
}

TEST(AngleBetween, IsExactAtBothEnds) {
  // acos of a dot product would lose such angles to rounding.
  const double small = 1e-9;
  EXPECT_NEAR(angle_between_rad({1, 0, 0}, {1, small, 0}), small, small * 1e-6);
  EXPECT_NEAR(angle_between_rad({1, 0, 0}, {-1, small, 0}), std::numbers::pi - small, 1e-15);
  EXPECT_NEAR(angle_between_rad({2, 0, 0}, {0, 0, 5}), std::numbers::pi / 2, kTiny);
  EXPECT_EQ(angle_between_rad({1, 2, 3}, {1, 2, 3}), 0.0);
}

}  // namespace
}  // namespace geometry
}  // namespace trocar
