#include <gtest/gtest.h>

#include <limits>

#include "core/random.h"
#include "core/testing/allocation_guard.h"
#include "devices/test/random_vec.h"
#include "devices/workspace_map.h"

namespace trocar::devices {
namespace {

using testing::random_vec;

/// Moment about E of a wrench about S.
Vec3 moment_about(const Vec3& p_SE, const Wrench& wrench) {
  return wrench.torque_nmm - p_SE.cross(wrench.force_n);
}

TEST(WithoutTorque, KeepsTheMomentAboutTheEntryPoint) {
  Random random(11);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 axis = random_vec(random, 1.0).normalized();
    const double lever_mm = random.uniform(kLeastLever_mm, 200.0) * (random.uniform() < 0.2 ? -1.0 : 1.0);
    const Vec3 off_axis = axis.unitOrthogonal() * random.uniform(0.0, 15.0);
    const Vec3 p_SE = lever_mm * axis + off_axis;
    const Wrench wrench{random_vec(random, 5.0), random_vec(random, 300.0)};
    const Wrench turned = without_torque(wrench, axis, p_SE);
    EXPECT_EQ(turned.torque_nmm, Vec3::Zero().eval());
    EXPECT_NEAR(turned.force_n.dot(axis), wrench.force_n.dot(axis), 1e-9);
    // What turns the needle: the part of the moment across it. About its own axis nobody feels it turn.
    const Vec3 change = moment_about(p_SE, turned) - moment_about(p_SE, wrench);
    EXPECT_LT((change - axis * change.dot(axis)).norm(), 1e-9);
  }
}

TEST(WithoutTorque, MatchesTheClosedForm) {
  // Needle along z, entry 100 mm ahead; 200 N mm about x turn the hub towards -y, as 2 N there along +y hold against.
  const Wrench turned = without_torque({{0.5, 0.0, -3.0}, {200.0, 0.0, 0.0}}, Vec3::UnitZ(), Vec3(0.0, 0.0, 100.0));
  EXPECT_LT((turned.force_n - Vec3(0.5, 2.0, -3.0)).norm(), 1e-12);
}

TEST(WithoutTorque, KeepsAForceWithoutTorque) {
  const Wrench wrench{{1.0, -2.0, 3.0}, Vec3::Zero()};
  EXPECT_EQ(without_torque(wrench, Vec3::UnitZ(), Vec3(5.0, 0.0, 80.0)).force_n, wrench.force_n);
}

TEST(WithoutTorque, KeepsTheForceOutsideTheBody) {
  const Wrench wrench{{1.0, -2.0, 3.0}, {50.0, 60.0, 70.0}};
  const Wrench turned = without_torque(wrench, Vec3::UnitZ(), std::nullopt);
  EXPECT_EQ(turned.force_n, wrench.force_n);
  EXPECT_EQ(turned.torque_nmm, Vec3::Zero().eval());
}

TEST(WithoutTorque, ShortLeverNeitherStepsNorAmplifiesTheForce) {
  const Wrench wrench{Vec3::Zero(), {80.0, 0.0, 0.0}};
  Vec3 before = without_torque(wrench, Vec3::UnitZ(), Vec3(0.0, 0.0, 60.0)).force_n;
  for (double lever_mm = 60.0; lever_mm > -60.0; lever_mm -= 0.1) {
    const Vec3 now = without_torque(wrench, Vec3::UnitZ(), Vec3(0.0, 0.0, lever_mm)).force_n;
    EXPECT_LE(now.norm(), 80.0 / kLeastLever_mm + 1e-9);
    EXPECT_LE((now - before).norm(), 0.1 * 80.0 / (kLeastLever_mm * kLeastLever_mm) + 1e-9) << lever_mm;
    before = now;
  }
  EXPECT_EQ(without_torque(wrench, Vec3::UnitZ(), Vec3(3.0, 0.0, 0.0)).force_n.norm(), 0.0);
}

TEST(WithoutTorque, PassesNonFiniteValuesAndNeverAllocates) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const testing::AllocationGuard guard;
  const Wrench turned = without_torque({{nan, 0.0, 0.0}, Vec3::Zero()}, Vec3::UnitZ(), Vec3(0.0, 0.0, 100.0));
  const Wrench huge = without_torque({Vec3::Constant(1e200), Vec3::Constant(1e200)}, Vec3::UnitZ(), Vec3(0, 0, 100.0));
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_FALSE(turned.force_n.allFinite());  // the gate refuses it
  EXPECT_TRUE(huge.force_n.allFinite());
}

}  // namespace
}  // namespace trocar::devices
