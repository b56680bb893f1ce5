#include "haptics/proxy/tip_proxy.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace trocar::testing {
namespace {

haptics::TipLaw border_law(double normal_n, double tangential_n) {
  haptics::TipLaw tip;
  tip.normal_P = Vec3::UnitZ();
  tip.border = 1.0;
  tip.law.normal_n = normal_n;
  tip.law.tangential_n = tangential_n;
  tip.law.resistance_n = 0.7;  // must not be felt on a border
  return tip;
}

haptics::TipLaw bulk_law(double resistance_n, double viscosity) {
  haptics::TipLaw tip;
  tip.law.resistance_n = resistance_n;
  tip.law.viscosity_ns_per_mm = viscosity;
  return tip;
}

/// Motion of a proxy at the origin that is tied to a tip at d by a spring without damper.
Vec3 motion_at(const Vec3& d, const haptics::TipLaw& law, double k = 1.0) {
  return haptics::proxy_motion(haptics::free_spring(k, 0.0, d, Vec3::Zero(), Vec3::Zero(), 0.001), law, Vec3::Zero());
}

/// Pulls the tip at constant velocity until the force is steady; the force on the tissue.
Vec3 steady_force(const haptics::TipLaw& law, const Vec3& velocity, double rate_hz) {
  const double dt = 1.0 / rate_hz;
  constexpr double kDamping_s = 0.004;
  Vec3 tip = Vec3::Zero();
  Vec3 proxy = Vec3::Zero();
  Vec3 force = Vec3::Zero();
  const auto ticks = static_cast<int>(2.0 * rate_hz);
  for (int i = 0; i < ticks; ++i) {
    tip += velocity * dt;
    const Vec3 target = tip + kDamping_s * velocity;
    const Vec3 motion = haptics::proxy_motion(haptics::free_spring(1.0, kDamping_s, target, proxy, Vec3::Zero(), dt),
                                              law, Vec3::Zero());
    proxy += motion;
    force = haptics::free_spring(1.0, kDamping_s, target, proxy, motion, dt).force_P;
  }
  return force;
}

/// The same along a path, with friction of the shaft and soft tissue at the tip.
haptics::NeedleBalance steady_needle(const haptics::TipLaw& law, double speed, double rate_hz,
                                     const haptics::AxialFriction& friction) {
  constexpr double kTissue_n_per_mm = 0.5;
  const double dt = 1.0 / rate_hz;
  double device = 0.0;
  double proxy = 0.0;
  haptics::NeedleBalance balance;
  const auto ticks = static_cast<int>(3.0 * rate_hz);
  for (int i = 0; i < ticks; ++i) {
    device += speed * dt;
    const haptics::CouplingParams coupling;
    const double ahead = device + coupling.damping_ns_per_mm / coupling.stiffness_n_per_mm * speed;
    const haptics::NeedleDrive drive{coupling, friction, ahead, balance.needle_mm, dt};
    const haptics::NeedleBalance before = haptics::balance_needle(drive, kTissue_n_per_mm, proxy);
    haptics::TipSpring spring;
    spring.dt_s = dt;
    spring.force_P = before.on_tip_n * spring.u_P;
    spring.axial_n_per_mm = before.tip_n_per_mm;
    proxy += haptics::proxy_motion(spring, law, Vec3::Zero()).z();
    balance = haptics::balance_needle(drive, kTissue_n_per_mm, proxy);
  }
  return balance;
}

TEST(TipProxy, StaysWhileTheForceIsBelowTheThreshold) {
  const haptics::TipLaw law = border_law(2.0, 0.5);
  EXPECT_EQ(motion_at({0, 0, 1.9}, law).norm(), 0.0);
  EXPECT_GT(motion_at({0, 0, 2.1}, law).norm(), 0.0);
  EXPECT_EQ(motion_at({0.4, 0, 0}, law).norm(), 0.0);
  EXPECT_GT(motion_at({0.6, 0, 0}, law).norm(), 0.0);
}

TEST(TipProxy, MovesAsEquationsThreeAndFourFromOnePointWithoutDamper) {
  const Vec3 motion = motion_at({1.5, 2.0, 4.0}, border_law(2.0, 0.5), 0.8);
  // x_p + N (d.N - T_N/k) and + T (d.T - T_T/k), k = 0.8
  const Vec3 tangent = Vec3(1.5, 2.0, 0.0) / 2.5;
  const Vec3 expected = Vec3::UnitZ() * (4.0 - 2.0 / 0.8) + tangent * (2.5 - 0.5 / 0.8);
  EXPECT_LT((motion - expected).norm(), 1e-12);
}

TEST(TipProxy, FollowsFreelyOutOfDenseTissue) {
  const Vec3 residual = haptics::residual_force({0, 0, -1.5}, border_law(2.0, 0.5), 0.0);
  EXPECT_LT((residual - Vec3(0, 0, -1.5)).norm(), 1e-15);  // nothing is borne: as printed it would stick for ever
}

TEST(TipProxy, MovesAsTheCorrectedEquationFive) {
  const Vec3 d(0.6, 0.0, 0.8);
  const Vec3 motion = motion_at(d, bulk_law(0.3, 0.0));
  EXPECT_LT((motion - d.normalized() * (1.0 - 0.3)).norm(), 1e-12);  // x_p + d^(|d| - R/k)
}

class Rates : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Hz, Rates, ::testing::Values(1000.0, 2000.0, 4000.0));

TEST_P(Rates, SteadyForceIsTheThresholdAtAnyRate) {
  const double rate = GetParam();
  EXPECT_NEAR(steady_force(border_law(2.0, 0.5), {0, 0, 20}, rate).z(), 2.0, 1e-9);
  EXPECT_NEAR(steady_force(border_law(2.0, 0.5), {20, 0, 0}, rate).x(), 0.5, 1e-9);
  EXPECT_NEAR(steady_force(bulk_law(0.3, 0.01), {0, 0, 20}, rate).z(), 0.3 + 0.01 * 20.0, 1e-9);
  EXPECT_NEAR(steady_force(bulk_law(0.3, 0.01), {12, 16, 0}, rate).norm(), 0.3 + 0.01 * 20.0, 1e-9);
}

TEST_P(Rates, AlongThePathShaftAndTipEachBearTheirOwn) {
  const haptics::NeedleBalance balance = steady_needle(bulk_law(0.3, 0.01), 20.0, GetParam(), {0.4, 0.02});
  EXPECT_NEAR(balance.on_tip_n, 0.3 + 0.01 * 20.0, 1e-9);
  EXPECT_NEAR(balance.on_shaft_n, 0.4 + 0.02 * 20.0, 1e-9);
}

TEST(NeedleBalance, DryFrictionHoldsTheNeedle) {
  const haptics::NeedleDrive drive{{}, {0.5, 0.0}, 0.4, 0.0, 0.001};
  const haptics::NeedleBalance held = haptics::balance_needle(drive, 1.0, 0.0);
  EXPECT_EQ(held.needle_mm, 0.0);
  EXPECT_NEAR(held.on_shaft_n, 0.4, 1e-12);  // k_c times the stretch
  EXPECT_EQ(held.on_tip_n, 0.0);
}

TEST(NeedleBalance, SetsTheSpringsInSeries) {
  haptics::CouplingParams coupling;
  coupling.damping_ns_per_mm = 0.0;
  const haptics::NeedleBalance balance = haptics::balance_needle({coupling, {}, 3.0, 0.0, 0.001}, 0.5, 0.0);
  EXPECT_NEAR(balance.on_tip_n, 3.0 * 0.5 / 1.5, 1e-12);
  EXPECT_NEAR(balance.tip_n_per_mm, 0.5 / 1.5, 1e-12);
}

TEST_P(Rates, AFastHandCannotOutrunViscosity) {
  // As printed, equation (5) moves the proxy by R/k a tick whatever the speed: the force would grow without end.
  EXPECT_NEAR(steady_force(bulk_law(0.3, 0.01), {0, 0, 500}, GetParam()).z(), 0.3 + 5.0, 1e-6);
}

TEST(TipProxy, BearsOnlyForcesOfAConvexSetAndNeverPushesTheTipOn) {
  Random random(11);
  for (int i = 0; i < 2000; ++i) {
    haptics::TipLaw law = border_law(random.uniform(0, 3), random.uniform(0, 1));
    law.border = random.uniform(0, 1);
    law.normal_P = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    const auto any = [&] { return Vec3(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)); };
    const double resistance = random.uniform(0, 1);
    const Vec3 a = any();
    const Vec3 b = any();
    const Vec3 borne_a = a - haptics::residual_force(a, law, resistance);
    const Vec3 borne_b = b - haptics::residual_force(b, law, resistance);
    EXPECT_LE((borne_a - borne_b).norm(), (a - b).norm() + 1e-12);                // a projection does not expand
    EXPECT_GE(borne_a.dot(haptics::residual_force(a, law, resistance)), -1e-12);  // the motion dissipates
    EXPECT_LT(haptics::residual_force(borne_a, law, resistance).norm(), 1e-9);  // and projecting again changes nothing
  }
}

TEST(TipLaw, ThresholdAlongIsTheGreatestBorneForceInThatDirection) {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    haptics::TipLaw law = border_law(2.0, 0.5);
    law.border = random.uniform(0, 1);
    const Vec3 u = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    double greatest = 0.0;
    for (int j = 0; j < 4000; ++j) {
      const Vec3 f = 20.0 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Vec3 borne = f - haptics::residual_force(f, law, (1.0 - law.border) * law.law.resistance_n);
      greatest = std::max(greatest, borne.dot(u));
    }
    EXPECT_LE(greatest, threshold_along_n(law, u) + 1e-9);
    EXPECT_GT(greatest, 0.93 * threshold_along_n(law, u));  // sampled: nearly reached
  }
}

}  // namespace
}  // namespace trocar::testing
