// How a simulated device is held.
#include <gtest/gtest.h>

#include <limits>

#include "devices/test/server_periods.h"

namespace trocar::devices {
namespace {

using namespace trocar::testing;

TEST(SimulatedHand, YieldsToAForceLikeTheHandSpring) {
  for (const double point_mm : {0.0, 160.0}) {
    const stylus::DevicePreset preset = preset_of("premium");
    Bench bench(preset);
    DeviceHand hand = holding(Pose(), bench.time_s);
    hand.point_mm = point_mm;
    bench.period(hand, {});
    DeviceReading reading;
    for (int i = 0; i < 2000; ++i) {
      hand.time_s = bench.time_s;
      Wrench wrench = weight_compensation(preset, reading.X_DS);
      wrench.force_n += Vec3(0.0, 0.0, 1.2);
      reading = bench.period(hand, wrench);
    }
    // 1.2 N along the stylus on 0.6 N/mm, less dry friction.
    EXPECT_NEAR(reading.X_DS.p().z(), 2.0, preset.friction_n / hand.stiffness_n_per_mm + 0.03) << point_mm;
    EXPECT_NEAR(reading.X_DS.p().x(), 0.0, 0.1) << point_mm;
  }
}

TEST(SimulatedHand, HeldAtTheTipSwingsAboutIt) {
  stylus::DevicePreset preset = preset_of("premium");
  preset.capability.stylus_weight_n = 0.0;
  Bench bench(preset);
  DeviceHand hand = holding(Pose(), bench.time_s);
  hand.point_mm = 100.0;
  bench.period(hand, {});
  for (int i = 0; i < 2000; ++i) {
    hand.time_s = bench.time_s;
    bench.period(hand, {{0.5, 0.0, 0.0}, Vec3::Zero()});
  }
  // 0.5 N across at S: 50 N mm about the tip on 300 N mm/rad, and the tip itself gives way by 0.5 N on 0.6 N/mm.
  const Pose X_DS = bench.device.X_DS();
  const Vec3 tip = X_DS * Vec3(0.0, 0.0, 100.0);
  const double angle = rotation_vector(X_DS.R()).norm();
  EXPECT_NEAR(angle, 50.0 / 300.0, 0.01);
  EXPECT_NEAR(tip.x(), 0.5 / 0.6, 0.1);
  EXPECT_GT(X_DS.p().x(), 10.0);
}

TEST(SimulatedHand, ChangingTheGripMovesNothing) {
  Bench bench(preset_of("premium"));
  const Pose X_DS(rotation_from_vector({0.2, -0.7, 0.1}), {5.0, 6.0, 7.0});
  DeviceHand hand = holding(X_DS, bench.time_s);
  hand.v_D = Vec3(50.0, -20.0, 10.0);
  hand.w_D = Vec3(1.0, 2.0, -3.0);
  hand.is_rigid = true;
  bench.period(hand, {});
  bench.period(hand, {});  // moves and turns
  const Pose before = bench.device.X_DS();
  const Vec3 v_before = bench.device.v_D();
  ASSERT_GT(v_before.norm(), 10.0);
  for (const double point_mm : {160.0, 20.0, 0.0}) {
    hand.point_mm = point_mm;
    bench.device.hold(hand);
    EXPECT_EQ(bench.device.X_DS().p(), before.p());
    EXPECT_EQ(bench.device.v_D(), v_before);
  }
  bench.device.hold({});
  EXPECT_EQ(bench.device.X_DS().p(), before.p());
}

TEST(SimulatedHand, PlacesTheStylusOncePerTarget) {
  Bench bench(ideal());
  DeviceHand hand = placed_at(Pose::translation({0.0, 0.0, 40.0}));
  for (int i = 0; i < 50; ++i) bench.period(hand, {});  // the same target, told every period
  EXPECT_LT(bench.device.X_DS().p().z(), 39.0);         // it fell all the while
  hand.time_s += 1.0;
  bench.device.hold(hand);
  EXPECT_EQ(bench.device.X_DS().p().z(), 40.0);
  EXPECT_EQ(bench.device.v_D().norm(), 0.0);
}

TEST(SimulatedHand, ExtrapolatesByVelocityBrieflyThenStops) {
  Bench bench(ideal());
  DeviceHand hand = holding(Pose(), bench.time_s);
  hand.v_D = Vec3(100.0, 0.0, 0.0);
  hand.is_rigid = true;
  bench.device.hold(hand);
  for (int i = 0; i < 40; ++i) bench.period(std::nullopt, {});
  EXPECT_NEAR(bench.device.X_DS().p().x(), 4.0, 1e-9);
  for (int i = 0; i < 100; ++i) bench.period(std::nullopt, {});
  EXPECT_NEAR(bench.device.X_DS().p().x(), 5.0, 1e-9);  // 50 ms of it
  EXPECT_EQ(bench.device.v_D().norm(), 0.0);
}

TEST(SimulatedHand, RigidHandFollowsExactlyAgainstForces) {
  Bench bench(ideal());
  const Pose X_DS(rotation_from_vector({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0});
  DeviceHand hand = holding(X_DS, bench.time_s);
  hand.is_rigid = true;
  for (int i = 0; i < 50; ++i) bench.period(hand, {{30.0, 30.0, 0.0}, {400.0, 0.0, 0.0}});
  EXPECT_LT((bench.device.X_DS().p() - X_DS.p()).norm(), 1e-12);
  EXPECT_LT((bench.device.X_DS().R() - X_DS.R()).norm(), 1e-12);
}

TEST(SimulatedHand, ReportsTheButtonsOfTheHand) {
  Bench bench(preset_of("premium"));
  DeviceHand hand = holding(Pose(), bench.time_s);
  hand.buttons = kButtonMain | kButtonSecond;
  bench.period(hand, {});
  EXPECT_EQ(bench.period(hand, {}).buttons, kButtonMain | kButtonSecond);
}

TEST(SimulatedHand, HandThatIsNotFiniteIsIgnored) {
  Bench bench(preset_of("premium"));
  const DeviceHand good = holding(Pose::translation({1.0, 0.0, 0.0}), bench.time_s);
  bench.period(good, {});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 6; ++i) {
    DeviceHand bad = good;
    if (i == 0) bad.X_DS = Pose::translation({nan, 0.0, 0.0});
    if (i == 1) bad.v_D.x() = nan;
    if (i == 2) bad.stiffness_n_per_mm = -1.0;
    if (i == 3) bad.mass_kg = nan;
    if (i == 4) bad.time_s = nan;
    if (i == 5) bad.inertia_kg_mm2 = -50.0;
    bench.period(bad, {});
    EXPECT_TRUE(bench.period(std::nullopt, {}).X_DS.is_finite()) << i;
  }
  EXPECT_NEAR(bench.device.X_DS().p().x(), 1.0, 0.2);  // held as before, less the sag under its weight
}

}  // namespace
}  // namespace trocar::devices
