#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "geometry/pose.h"
#include "haptics/insertion/insertion_law.h"

namespace trocar::haptics {
namespace {

const PathLine kLine{{3.0, -2.0, 10.0}, Vec3(0.2, 0.5, 1.0).normalized()};
const PathConstraintParams kParams;

constexpr double kStylusToTip_mm = 150.0;

/// A needle with its stylus origin `aside_P` (across the path) beside the path and its tip `depth_mm` deep.
NeedleAtPath beside(double depth_mm, const Vec3& aside_P = Vec3::Zero(), const Vec3& axis_P = kLine.direction_P) {
  const double stylus_mm = depth_mm - kStylusToTip_mm * axis_P.dot(kLine.direction_P);
  return {kLine.origin_P + stylus_mm * kLine.direction_P + aside_P, axis_P, kStylusToTip_mm};
}

Wrench at_rest(const NeedleAtPath& needle, const PathConstraintParams& params = kParams) {
  return path_constraint(kLine, needle, needle, params);
}

TEST(PathConstraint, VanishesOnThePath) {
  for (const double depth : {-5.0, 0.0, 3.0, 40.0}) {
    const Wrench wrench = at_rest(beside(depth));
    EXPECT_NEAR(wrench.force_n.norm(), 0.0, 1e-12);
    EXPECT_EQ(wrench.torque_nmm.norm(), 0.0);
  }
}

TEST(PathConstraint, IsLinearNearThePathAndConstantBeyond) {
  const Vec3 side = kLine.direction_P.unitOrthogonal();
  const double stiffness = kParams.force_n / kParams.linear_mm;
  for (const double d : {0.1, 1.0, 2.0}) {
    const Wrench wrench = at_rest(beside(80.0, d * side));
    EXPECT_LT((wrench.force_n + stiffness * d * side).norm(), 1e-12);  // straight back to the closest point
  }
  const Wrench far = at_rest(beside(80.0, 12.0 * side));
  EXPECT_LT((far.force_n + kParams.force_n * side).norm(), 1e-12);  // m(d) d with m = m0/d: the paper's form
}

TEST(PathConstraint, HasNoAxialPartPastItsFadeAndNeverPullsInwards) {
  const Vec3 side = 3.0 * kLine.direction_P.unitOrthogonal();
  const Vec3 tilted = (kLine.direction_P + 0.1 * kLine.direction_P.unitOrthogonal()).normalized();
  double most_outward_n = 0.0;
  for (double depth = -1.0; depth < 60.0; depth += 0.1) {
    const double inward_n = at_rest(beside(depth, side, tilted)).force_n.dot(kLine.direction_P);
    const bool is_in_fade = depth > 0.0 && depth < kParams.fade_mm;
    EXPECT_LE(is_in_fade ? 0.0 : std::abs(inward_n), 1e-12) << depth;
    EXPECT_LE(inward_n, 1e-12) << depth;
    most_outward_n = std::max(most_outward_n, -inward_n);
  }
  EXPECT_GT(most_outward_n, 0.1);  // the work that builds the springs up
}

TEST(PathConstraint, FadesInFromNothingAtTheSkin) {
  const Vec3 side = 3.0 * kLine.direction_P.unitOrthogonal();
  constexpr double kStep_mm = 0.01;
  Vec3 before = Vec3::Zero();
  for (double depth = -1.0; depth < 25.0; depth += kStep_mm) {
    const Wrench wrench = at_rest(beside(depth, side));
    EXPECT_EQ(wrench.force_n.norm() > 0.0, depth > 0.0) << depth;
    EXPECT_LT((wrench.force_n - before).norm(), kParams.force_n * 2.0 / kParams.fade_mm * kStep_mm);
    before = wrench.force_n;
  }
  EXPECT_NEAR(before.norm(), kParams.force_n, 1e-12);
}

TEST(PathConstraint, TurnsTheNeedleBackOntoThePath) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3 axis =
        (kLine.direction_P + 0.5 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)))
            .normalized();
    const Wrench wrench = at_rest(beside(40.0, Vec3::Zero(), axis));
    const double theta = std::acos(std::min(1.0, axis.dot(kLine.direction_P)));
    const double expected = kParams.torque_nmm * std::min(1.0, theta / kParams.linear_rad);
    EXPECT_NEAR(wrench.torque_nmm.norm(), expected, 1e-6);
    const Vec3 turned = axis + 1e-6 * wrench.torque_nmm.cross(axis);
    EXPECT_GT(turned.normalized().dot(kLine.direction_P), axis.dot(kLine.direction_P));
  }
}

TEST(PathConstraint, WrenchIsTheGradientOfOneEnergy) {
  Random random(9);
  const auto within = [&](double a) {
    return Vec3(random.uniform(-a, a), random.uniform(-a, a), random.uniform(-a, a));
  };
  for (int i = 0; i < 300; ++i) {
    const Vec3 tip_P = kLine.origin_P + random.uniform(0.5, 40.0) * kLine.direction_P + within(5.0);
    const Mat3 R = needle_pose(tip_P, (kLine.direction_P + within(0.2)).normalized()).R();
    const Vec3 stylus_P = tip_P - kStylusToTip_mm * R.col(2);
    const Wrench wrench = at_rest({stylus_P, R.col(2), kStylusToTip_mm});
    constexpr double kMove_mm = 1e-4;
    constexpr double kTurn_rad = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 e = Vec3::Unit(axis);
      const auto energy = [&](double move, double turn) {
        return path_energy_nmm(kLine, {stylus_P + move * e, Eigen::AngleAxisd(turn, e) * R.col(2), kStylusToTip_mm},
                               kParams);
      };
      EXPECT_NEAR((energy(kMove_mm, 0) - energy(-kMove_mm, 0)) / (2 * kMove_mm), -wrench.force_n[axis], 1e-4);
      EXPECT_NEAR((energy(0, kTurn_rad) - energy(0, -kTurn_rad)) / (2 * kTurn_rad), -wrench.torque_nmm[axis], 1e-2);
    }
  }
}

TEST(PathConstraint, PredictedPoseOnlyDamps) {
  Random random(13);
  const auto within = [&](double a) {
    return Vec3(random.uniform(-a, a), random.uniform(-a, a), random.uniform(-a, a));
  };
  for (int i = 0; i < 500; ++i) {
    const NeedleAtPath now = beside(random.uniform(0.0, 40.0), within(6.0));
    const Vec3 way_P = within(1.0);
    const NeedleAtPath ahead{now.stylus_P + way_P, now.axis_P, now.length_mm};
    const Vec3 damping_n = path_constraint(kLine, now, ahead, kParams).force_n - at_rest(now).force_n;
    EXPECT_LE(damping_n.dot(way_P), 1e-12);
  }
}

TEST(Renderable, KeepsTheForcesAndBoundsTheTurning) {
  for (const double linear_rad : {0.01, 0.1, 1.0}) {
    PathConstraintParams wanted = kParams;
    wanted.linear_rad = linear_rad;
    const PathConstraintParams params = renderable(wanted);
    EXPECT_EQ(params.force_n, wanted.force_n);
    EXPECT_EQ(params.linear_mm, wanted.linear_mm);
    EXPECT_EQ(params.torque_nmm, wanted.torque_nmm);
    EXPECT_GE(params.linear_rad, wanted.linear_rad);
    EXPECT_LE(params.torque_nmm / params.linear_rad, kMostPathTurning_nmm_per_rad * (1.0 + 1e-12));
  }
  EXPECT_EQ(renderable(kParams).linear_rad, kParams.linear_rad);
}

}  // namespace
}  // namespace trocar::haptics
