#include "stylus/virtual_stylus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "core/testing/allocation_guard.h"
#include "haptics/test/tick_period.h"
#include "lab/haptics/closed_loop.h"
#include "lab/haptics/passivity_observer.h"
#include "stylus/device_preset.h"

namespace trocar::haptics {
namespace {

using testing::kDt_s;

TEST(VirtualStylus, FallsFreely) {
  stylus::VirtualStylusState state;
  stylus::VirtualStylusParams params;
  params.mass_kg = 0.1;
  params.weight_n = 0.981;
  for (int i = 0; i < 1000; ++i) stylus::step_stylus(state, params, {}, {}, Vec3::UnitY(), kDt_s);
  EXPECT_NEAR(state.v_P.y(), 9810.0, 1e-6);
  EXPECT_NEAR(state.X_PS.p().y(), 0.5 * 9810.0, 1e-6);
  EXPECT_LT((state.X_PS.R() - Mat3::Identity()).norm(), 1e-12);
}

TEST(VirtualStylus, StaysFiniteForAnAbsurdlySmallPeriod) {
  for (const double dt_s : {std::numeric_limits<double>::denorm_min(), 1e-300, 1e-30, 1e-12}) {
    stylus::VirtualStylusState state;
    state.v_P = {3.0, 0.0, -2.0};
    const stylus::VirtualStylusState before = state;
    stylus::StylusHold hold = stylus::make_hand();
    const Wrench wrench{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
    for (int i = 0; i < 100; ++i) {
      const stylus::StylusMotion motion = stylus::step_stylus(state, {}, hold, wrench, Vec3::UnitY(), dt_s);
      ASSERT_TRUE(motion.v_P.allFinite() && motion.w_P.allFinite()) << dt_s;
    }
    ASSERT_TRUE(state.X_PS.is_finite() && state.v_P.allFinite() && state.w_P.allFinite()) << dt_s;
    EXPECT_LT((state.X_PS.p() - before.X_PS.p()).norm(), 1e-6) << dt_s;
  }
}

TEST(VirtualStylus, TurnsUnderATorqueAccordingToItsInertia) {
  stylus::VirtualStylusState state;
  stylus::VirtualStylusParams params;
  params.inertia_kg_mm2 = 100.0;  // 0.1 N mm s^2
  params.weight_n = 0.0;
  const Wrench wrench{Vec3::Zero(), {0.1, 0.0, 0.0}};
  for (int i = 0; i < 500; ++i) stylus::step_stylus(state, params, {}, wrench, Vec3::UnitY(), kDt_s);
  EXPECT_NEAR(state.w_P.x(), 0.5, 1e-9);
  EXPECT_NEAR(rotation_vector(state.X_PS.R()).x(), 0.5 * 0.5 * 0.5, 1e-9);
}

/// Period of a component that swings about zero, from its upward crossings.
template <class Sample>
double period_s(const Sample& sample, int ticks, double dt_s) {
  double first = -1.0;
  double last = -1.0;
  int count = 0;
  double before = sample();
  for (int i = 1; i < ticks; ++i) {
    const double now = sample();
    if (before < 0.0 && now >= 0.0) {
      const double crossing = (i - now / (now - before)) * dt_s;
      if (first < 0.0) first = crossing;
      last = crossing;
      ++count;
    }
    before = now;
  }
  return (last - first) / (count - 1);
}

TEST(VirtualStylus, SwingsWithThePeriodOfItsSprings) {
  constexpr double kFine_s = 1e-4;  // the period errs by (omega dt)^2/12
  stylus::VirtualStylusParams params;
  params.mass_kg = 0.1;
  params.inertia_kg_mm2 = 50.0;
  params.weight_n = 0.0;
  stylus::StylusHold hold;
  hold.stiffness_n_per_mm = 0.6;
  hold.turning_nmm_per_rad = 300.0;
  stylus::VirtualStylusState state;
  state.X_PS = Pose(rotation_from_vector({0.0, 0.1, 0.0}), {1.0, 0.0, 0.0});
  const auto step = [&] { stylus::step_stylus(state, params, hold, {}, Vec3::UnitY(), kFine_s); };
  const double linear = period_s(
      [&] {
        step();
        return state.X_PS.p().x();
      },
      10000, kFine_s);
  EXPECT_NEAR(linear, 2.0 * std::numbers::pi * std::sqrt(0.1 / 600.0), 1e-4);
  state.X_PS = Pose(rotation_from_vector({0.0, 0.1, 0.0}), Vec3::Zero());
  const double turning = period_s(
      [&] {
        step();
        return rotation_vector(state.X_PS.R()).y();
      },
      10000, kFine_s);
  EXPECT_NEAR(turning, 2.0 * std::numbers::pi * std::sqrt(0.05 / 300.0), 1e-4);
}

/// A stylus held at a point far from its mass, without weight.
stylus::StylusHold held_at(double point_mm) {
  stylus::StylusHold hold;
  hold.point_mm = point_mm;
  hold.stiffness_n_per_mm = 1000.0;
  return hold;
}
stylus::VirtualStylusParams weightless() {
  stylus::VirtualStylusParams params;
  params.weight_n = 0.0;
  return params;
}

TEST(VirtualStylus, SwingsAboutItsGraspPoint) {
  constexpr double kFine_s = 1e-4;
  constexpr double kPoint_mm = 150.0;
  stylus::StylusHold hold = held_at(kPoint_mm);
  hold.turning_nmm_per_rad = 1500.0;
  stylus::VirtualStylusState state;
  const Mat3 turned = rotation_from_vector({0.0, 0.02, 0.0});
  state.X_PS = Pose(turned, Vec3(0.0, 0.0, kPoint_mm) - kPoint_mm * turned.col(2));
  const double period = period_s(
      [&] {
        stylus::step_stylus(state, weightless(), hold, {}, Vec3::UnitY(), kFine_s);
        EXPECT_LT((state.X_PS * Vec3(0.0, 0.0, kPoint_mm) - Vec3(0.0, 0.0, kPoint_mm)).norm(), 0.01);
        return rotation_vector(state.X_PS.R()).y();
      },
      20000, kFine_s);
  const double inertia = 0.05 + 0.1 / 1000.0 * kPoint_mm * kPoint_mm;  // N mm s^2: of the stylus, and of its mass
  EXPECT_NEAR(period, 2.0 * std::numbers::pi * std::sqrt(inertia / 1500.0), 1e-3);
}

TEST(VirtualStylus, ConservesEnergyAndMomentumWhenHeldAtAPoint) {
  constexpr double kFine_s = 1e-5;
  stylus::StylusHold hold;  // a lump at the tip, with no spring: stylus and lump fly as a dumb-bell
  hold.point_mm = 100.0;
  hold.mass_kg = 0.1;
  stylus::VirtualStylusState state;
  state.v_P = Vec3(-100.0, 0.0, 20.0);
  state.w_P = Vec3(0.0, 2.0, 0.0);
  const auto velocity_of_lump = [&] {
    const Vec3 r = hold.point_mm * state.X_PS.R().col(2);
    return Vec3(state.v_P + state.w_P.cross(r));
  };
  const auto momentum = [&] { return Vec3(0.1 * (state.v_P + velocity_of_lump())); };
  const auto energy = [&] {
    return 0.05 * (state.v_P.squaredNorm() + velocity_of_lump().squaredNorm()) + 0.5 * 50.0 * state.w_P.squaredNorm();
  };
  const Vec3 momentum_before = momentum();
  const double energy_before = energy();
  for (int i = 0; i < 100000; ++i) stylus::step_stylus(state, weightless(), hold, {}, Vec3::UnitY(), kFine_s);
  EXPECT_GT(rotation_vector(state.X_PS.R()).norm(), 1.9);  // two radians on
  EXPECT_LT((momentum() - momentum_before).norm(), 2e-3 * momentum_before.norm());
  EXPECT_NEAR(energy() / energy_before, 1.0, 2e-3);
}

TEST(VirtualStylus, FrictionHoldsAgainstASmallerPush) {
  stylus::VirtualStylusParams params = weightless();
  params.friction_n = 0.2;
  params.turning_friction_nmm = 0.5;
  for (const double point_mm : {0.0, 150.0}) {
    stylus::StylusHold hold = stylus::make_guiding_hand(point_mm);
    stylus::VirtualStylusState state;
    hold.X_PS = state.X_PS;
    for (int i = 0; i < 200; ++i)
      stylus::step_stylus(state, params, hold, {{0.19, 0.0, 0.0}, Vec3::Zero()}, Vec3::UnitY(), kDt_s);
    EXPECT_EQ(state.X_PS.p().norm(), 0.0) << point_mm;
    EXPECT_EQ(state.v_P.norm(), 0.0) << point_mm;
    for (int i = 0; i < 2000; ++i)
      stylus::step_stylus(state, params, hold, {{0.5, 0.0, 0.0}, Vec3::Zero()}, Vec3::UnitY(), kDt_s);
    EXPECT_GT(state.X_PS.p().x(), 0.1) << point_mm;
  }
}

TEST(VirtualStylus, HoldIsStableForAnyStep) {
  for (const double dt_s : {1e-4, 1e-3, 0.01, 0.1, 1.0}) {
    stylus::StylusHold hold;
    hold.stiffness_n_per_mm = 5.0;
    hold.turning_nmm_per_rad = 5000.0;
    stylus::VirtualStylusState state;
    state.X_PS = Pose(rotation_from_vector({0.3, -1.0, 0.4}), {5.0, -3.0, 1.0});
    double angle = rotation_vector(state.X_PS.R()).norm();
    for (int i = 0; i < 20000; ++i) {
      stylus::step_stylus(state, {}, hold, {}, Vec3::Zero(), dt_s);
      ASSERT_LE(state.X_PS.p().norm(), 6.0) << dt_s;
      ASSERT_LE(rotation_vector(state.X_PS.R()).norm(), 1.13) << dt_s;
    }
    EXPECT_LT(rotation_vector(state.X_PS.R()).norm(), angle);
    EXPECT_LT((state.X_PS.R().transpose() * state.X_PS.R() - Mat3::Identity()).norm(), 1e-9);
  }
}

TEST(VirtualStylus, NeverAllocates) {
  stylus::VirtualStylusState state;
  stylus::StylusHold hold;
  hold.turning_nmm_per_rad = 1.0;
  const testing::AllocationGuard guard;
  stylus::step_stylus(state, {}, hold, {}, Vec3::UnitY(), kDt_s);
  const Pose told = stylus::quantise(state.X_PS, {});
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_TRUE(told.is_finite());
}

TEST(RotationVector, RoundTripsThroughARotation) {
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    Vec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    v *= random.uniform(0.0, 3.1) / v.norm();
    EXPECT_LT((rotation_vector(rotation_from_vector(v)) - v).norm(), 1e-9);
  }
  EXPECT_EQ(rotation_vector(Mat3::Identity()).norm(), 0.0);
  EXPECT_NEAR(rotation_vector(rotation_from_vector({1e-9, 0, 0})).x(), 1e-9, 1e-15);
}

TEST(Encoder, QuantisesThePoseWithinHalfACount) {
  constexpr stylus::EncoderParams kEncoder{0.03, 0.01};
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 turn(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
    const Pose X(rotation_from_vector(turn),
                 {random.uniform(-100, 100), random.uniform(-100, 100), random.uniform(-100, 100)});
    const Pose told = stylus::quantise(X, kEncoder);
    EXPECT_LE((told.p() - X.p()).cwiseAbs().maxCoeff(), 0.015 + 1e-12);
    EXPECT_NEAR(std::remainder(told.p().x(), 0.03), 0.0, 1e-9);
    EXPECT_LE(rotation_vector(told.R() * X.R().transpose()).norm(), 0.005 * std::sqrt(3.0) + 1e-9);
  }
  const Pose X(rotation_from_vector({0.1, 0.2, 0.3}), {1, 2, 3});
  EXPECT_EQ(stylus::quantise(X, {0.0, 0.0}).p(), X.p());
  EXPECT_EQ(stylus::quantise(X, {0.0, 0.0}).R(), X.R());
}

TEST(Encoder, PassesNonFiniteValuesThrough) {
  const double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(stylus::quantise(Pose::translation({kNan, 0, 0}), {}).is_finite());  // the tick refuses it
  EXPECT_TRUE(stylus::quantise(Pose::translation({1e300, 0, 0}), {}).is_finite());
}

/// A mass of 0.1 kg on the spring and damper of a haptic side that is sampled, computed and held; 0.5 mJ in the spring.
PassivityObserver observe_swing(double k_n_per_mm, double b_ns_per_mm) {
  stylus::VirtualStylusParams params;
  params.weight_n = 0.0;
  stylus::VirtualStylusState state;
  state.X_PS = Pose::translation({1.0, 0.0, 0.0});
  PassivityObserver observer;
  Wrench wrench;
  for (int i = 0; i < 200; ++i) {
    const stylus::StylusMotion motion = stylus::step_stylus(state, params, {}, wrench, Vec3::UnitY(), kDt_s);
    observer.add(wrench, motion.v_P, motion.w_P, kDt_s);
    wrench.force_n = -k_n_per_mm * state.X_PS.p() - b_ns_per_mm * state.v_P;
  }
  return observer;
}

TEST(PassivityObserver, MeasuresEnergyOfASampledSpringAndADamper) {
  // A spring held for a tick T acts as a damper of -kT/2: in 0.2 s the energy grows to 0.5 mJ exp(0.2 kT/2m), all of it
  // motion at the last zero of the spring, a little earlier.
  const double growth_mj = observe_swing(1.0, 0.0).growth_mj();
  EXPECT_LT(growth_mj, 0.5 * std::exp(1.0));
  EXPECT_GT(growth_mj, 0.5 * std::exp(0.8));
  EXPECT_LT(observe_swing(1.0, 0.004).growth_mj(), 0.5 + 1e-3);  // passive: no more than had been stored
}

}  // namespace
}  // namespace trocar::haptics
