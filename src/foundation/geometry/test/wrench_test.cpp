#include <gtest/gtest.h>

#include "geometry/vec.h"

namespace trocar {
namespace {

/// The power of a wrench on a rigid body is the same about any point.
TEST(Wrench, KeepsItsPowerAboutAnotherPoint) {
  const Wrench wrench{{1.0, -2.0, 0.5}, {30.0, 4.0, -12.0}};
  const Vec3 v(3.0, 1.0, -2.0), w(0.2, -0.1, 0.4), to(10.0, -5.0, 7.0);
  const Wrench moved = wrench.shifted_to(to);
  const double power = wrench.force_n.dot(v) + wrench.torque_nmm.dot(w);
  EXPECT_NEAR(moved.force_n.dot(v + w.cross(to)) + moved.torque_nmm.dot(w), power, 1e-12);
  EXPECT_LT((moved.shifted_to(-to).torque_nmm - wrench.torque_nmm).norm(), 1e-12);
}

TEST(Wrench, AddsSubtractsScalesAndRotates) {
  const Wrench a{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}, b{{0.5, 0.0, -1.0}, {2.0, 0.0, 1.0}};
  EXPECT_EQ((a + b - b).force_n, a.force_n);
  EXPECT_EQ((2.0 * a).torque_nmm, Vec3(8.0, 10.0, 12.0));
  Mat3 R;  // a quarter turn about z
  R << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  EXPECT_EQ((R * a).force_n, Vec3(-2.0, 1.0, 3.0));
  Wrench sum;
  sum += a;
  EXPECT_EQ(sum.torque_nmm, a.torque_nmm);
}

}  // namespace
}  // namespace trocar
