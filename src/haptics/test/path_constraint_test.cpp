#include "haptics/path_constraint.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace trocar {
namespace {

const Vec3 kOrigin(3.0, -2.0, 10.0);
const Vec3 kAxis = Vec3(0.2, 0.5, 1.0).normalized();
const PathConstraintParams kParams;

TEST(PathConstraint, VanishesOnThePath) {
  const Wrench wrench = path_constraint(kOrigin, kAxis, kOrigin + 40.0 * kAxis, kAxis, kParams);
  EXPECT_NEAR(wrench.force_n.norm(), 0.0, 1e-12);
  EXPECT_EQ(wrench.torque_nmm.norm(), 0.0);
}

TEST(PathConstraint, IsLinearNearThePathAndConstantBeyond) {
  const Vec3 side = kAxis.unitOrthogonal();
  const double stiffness = kParams.force_n / kParams.linear_mm;
  for (const double d : {0.1, 1.0, 2.0}) {
    const Wrench wrench = path_constraint(kOrigin, kAxis, kOrigin + 80.0 * kAxis + d * side, kAxis, kParams);
    EXPECT_NEAR(wrench.force_n.norm(), stiffness * d, 0.002 * stiffness * d);
    EXPECT_LT(wrench.force_n.dot(side), 0.0);  // towards the path
  }
  const Wrench far = path_constraint(kOrigin, kAxis, kOrigin + 80.0 * kAxis + 12.0 * side, kAxis, kParams);
  EXPECT_NEAR(far.force_n.norm(), kParams.force_n, 1e-9);  // m(d) d with m = m0/d: the paper's form
}

TEST(PathConstraint, TurnsTheNeedleBackOntoThePath) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3 axis =
        (kAxis + 0.5 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))).normalized();
    const Wrench wrench = path_constraint(kOrigin, kAxis, kOrigin + 40.0 * kAxis, axis, kParams);
    const double theta = std::acos(std::min(1.0, axis.dot(kAxis)));
    const double expected = kParams.torque_nmm * std::min(1.0, theta / kParams.linear_rad);
    EXPECT_NEAR(wrench.torque_nmm.norm(), expected, 1e-6);
    const Vec3 turned = axis + 1e-6 * wrench.torque_nmm.cross(axis);
    EXPECT_GT(turned.normalized().dot(kAxis), axis.dot(kAxis));
  }
}

}  // namespace
}  // namespace trocar
