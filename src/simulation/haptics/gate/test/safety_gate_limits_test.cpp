#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/random.h"
#include "haptics/gate/safety_gate.h"
#include "haptics/gate/test/gate_rig.h"
#include "haptics/test/tick_period.h"

namespace trocar::haptics {
namespace {

using testing::force_n;
using testing::kDt_s;
using testing::open_gate;
using testing::wanting;

// --- absurdly small periods ---

TEST(SafetyGate, StaysFiniteForAnAbsurdlySmallPeriod) {
  for (const double dt_s : {std::numeric_limits<double>::denorm_min(), 1e-300, 1e-30, 1e-12}) {
    GateState state = open_gate();
    for (int i = 0; i < 200; ++i) {
      GateInput input = wanting({0.0, 3.0, 4.0}, {10.0, 0.0, 0.0});
      input.dt_s = dt_s;
      input.v_mm_per_s = Vec3(0.0, 10.0, 5.0);
      input.coupling = {0.8, 0.0025};
      const GateOutput output = step_gate(state, input, {});
      ASSERT_TRUE(output.wrench.force_n.allFinite() && output.wrench.torque_nmm.allFinite()) << dt_s;
      ASSERT_TRUE(std::isfinite(state.energy_mj) && std::isfinite(state.force_heat)) << dt_s;
      ASSERT_LE(force_n(output), GateParams{}.peak_force_n) << dt_s;
    }
    for (int i = 0; i < 300; ++i) {
      GateInput off = wanting(Vec3::Zero());
      off.is_wanted = false;
      step_gate(state, off, {});
    }
    EXPECT_EQ(state.last.force_n.norm(), 0.0) << "the gate still closes";
  }
}

// --- drops and rises ---

TEST(GateSlew, AllowsAPunctureDropWithinOnePeriodAndReportsIt) {
  GateState state = open_gate();
  for (int i = 0; i < 10; ++i) step_gate(state, wanting({0, 0, 4.5}), {});
  GateOutput output = step_gate(state, wanting({0, 0, 0.5}), {});
  EXPECT_DOUBLE_EQ(output.wrench.force_n.z(), 0.5) << "4 N in one period, far below 5 ms";
  EXPECT_FALSE(output.actions & kGateSlew);
  EXPECT_EQ(output.drop_n, 0.0) << "not over yet";
  output = step_gate(state, wanting({0, 0, 0.5}), {});
  EXPECT_NEAR(output.drop_n, 4.0, 1e-9);
  EXPECT_NEAR(output.drop_s, kDt_s, 1e-12);
  output = step_gate(state, wanting({0, 0, 0.5}), {});
  EXPECT_EQ(output.drop_n, 0.0) << "told once";
}

TEST(GateSlew, ReportsTheDurationOfADrop) {
  GateState state = open_gate();
  for (int i = 0; i < 10; ++i) step_gate(state, wanting({0, 0, 4}), {});
  for (int i = 1; i <= 4; ++i)
    EXPECT_DOUBLE_EQ(step_gate(state, wanting({0, 0, 4.0 - i}), {}).wrench.force_n.z(), 4.0 - i);
  const GateOutput output = step_gate(state, wanting(Vec3::Zero()), {});
  EXPECT_NEAR(output.drop_n, 4.0, 1e-9);
  EXPECT_NEAR(output.drop_s, 4 * kDt_s, 1e-12);
}

TEST(GateSlew, DoesNotReportASlowReleaseAsADrop) {
  GateState state = open_gate();
  for (int i = 0; i < 10; ++i) step_gate(state, wanting({0, 0, 4}), {});
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(step_gate(state, wanting({0, 0, 4.0 - 0.004 * i}), {}).drop_n, 0.0);
}

TEST(GateSlew, LimitsRisesToItsRate) {
  const GateParams params;
  GateState state = open_gate();
  for (int i = 1; i <= 5; ++i) {
    const GateOutput output = step_gate(state, wanting({0, 0, 18}, {0, 300, 0}), params);
    EXPECT_NEAR(force_n(output), std::min(18.0, i * params.slew_n_per_s * kDt_s), 1e-9);
    EXPECT_NEAR(output.wrench.torque_nmm.norm(), std::min(300.0, i * params.slew_nmm_per_s * kDt_s), 1e-9);
    EXPECT_EQ((output.actions & kGateSlew) != 0, i < 5);
  }
}

TEST(GateSlew, ReversesAForceThroughZeroAtOnce) {
  const GateParams params;
  GateState state = open_gate();
  for (int i = 0; i < 10; ++i) step_gate(state, wanting({0, 0, 10}), params);
  const GateOutput output = step_gate(state, wanting({0, 0, -10}), params);
  EXPECT_NEAR(output.wrench.force_n.z(), -params.slew_n_per_s * kDt_s, 1e-9);
}

TEST(GateSlew, NeverDelaysAFallInAnyDirection) {
  Random random(3);
  const GateParams params;
  for (int round = 0; round < 2000; ++round) {
    GateState state = open_gate();
    const Vec3 full(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    for (int i = 0; i < 5; ++i) step_gate(state, wanting(full), params);
    const double share = random.uniform();
    const GateOutput output = step_gate(state, wanting(share * full), params);
    ASSERT_LT((output.wrench.force_n - share * full).norm(), 1e-9);
  }
}

TEST(GateSlew, LimitsTheRiseAfterALoopGap) {
  const GateParams params;
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 30});
  input.dt_s = 0.08;
  EXPECT_LE(force_n(step_gate(state, input, params)), params.slew_n_per_s * 0.005 + 1e-9);
}

// --- warmth ---

TEST(GateWarmth, SettlesAtTheContinuousForceUnderTheFullPeak) {
  const GateParams params;  // the Premium: 37.5 N peak, 6.2 N continuous, 10 s
  GateState state = open_gate();
  const double start_heat = state.force_heat;
  double square_s = 0.0;
  double peak_s = 0.0;
  double window_s = 0.0;
  for (int i = 1; i <= 100000; ++i) {
    const GateOutput output = step_gate(state, wanting({0, 0, 37.5}), params);
    const double now = output.wrench.force_n.squaredNorm() * kDt_s;
    square_s += now;
    if (i > 60000) window_s += now;
    if (force_n(output) > 0.999 * params.peak_force_n) peak_s += kDt_s;
    const double time_s = i * kDt_s;
    const double continuous2 = params.continuous_force_n * params.continuous_force_n;
    ASSERT_LE(square_s, continuous2 * (time_s + params.thermal_time_s * (1.0 - start_heat)) * 1.001 + 1.0);
    ASSERT_LE(state.force_heat, 1.0 + 1e-3);
  }
  // The peak lasts until the heat is 0.8: t = -T ln(1 - 0.8 c^2/p^2), and a little into the smooth part; 10 ms to rise.
  const double ratio = std::pow(params.continuous_force_n / params.peak_force_n, 2.0);
  EXPECT_NEAR(peak_s, -params.thermal_time_s * std::log(1.0 - 0.8 * ratio), 0.02);
  EXPECT_NEAR(std::sqrt(window_s / 40.0), params.continuous_force_n, 0.005 * params.continuous_force_n);
  EXPECT_LE(std::sqrt(window_s / 40.0), params.continuous_force_n * (1.0 + 1e-6));
}

TEST(GateWarmth, BoundsTheMeanSquareForceOverLongWindows) {
  Random random(23);
  for (int round = 0; round < 10; ++round) {
    GateParams params;
    params.thermal_time_s = random.uniform(0.5, 5.0);
    params.continuous_force_n = random.uniform(1.0, 10.0);
    params.continuous_torque_nmm = random.uniform(20.0, 200.0);
    GateState state = open_gate(params);
    double force_s = 0.0;
    double torque_s = 0.0;
    GateInput input;
    for (int i = 0; i < 50000; ++i) {
      if (i % 400 == 0) input = wanting({0, 0, random.uniform(-40, 40)}, {random.uniform(-600, 600), 0, 0});
      const GateOutput output = step_gate(state, input, params);
      force_s += output.wrench.force_n.squaredNorm() * kDt_s;
      torque_s += output.wrench.torque_nmm.squaredNorm() * kDt_s;
    }
    const double bound_s = (50.0 + params.thermal_time_s) * 1.02;  // 2 %: the step of a period beyond heat 1
    EXPECT_LE(force_s, params.continuous_force_n * params.continuous_force_n * bound_s);
    EXPECT_LE(torque_s, params.continuous_torque_nmm * params.continuous_torque_nmm * bound_s);
  }
}

TEST(GateWarmth, PassesAContinuousForceForever) {
  const GateParams params;
  GateState state = open_gate();
  for (int i = 0; i < 60000; ++i) {
    const GateOutput output = step_gate(state, wanting({0, 0, params.continuous_force_n * 0.999}), params);
    ASSERT_NEAR(force_n(output), params.continuous_force_n * 0.999, i > 2 ? 1e-9 : 6.2);
  }
}

TEST(GateRoll, LimitsTheTorqueAboutTheAxisToItsOwnPeak) {
  const GateParams params;  // the Premium: 515 N mm, 170 about the stylus
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(0, 0, -2), Vec3(0.6, 0, 0.8)}) {
    GateState state = open_gate();
    const Vec3 along = axis.normalized();
    const Vec3 across = along.cross(Vec3::UnitY()).normalized();
    GateInput input = wanting(Vec3::Zero(), 300.0 * along + 300.0 * across);
    input.axis = axis;
    GateOutput output;
    for (int i = 0; i < 50; ++i) output = step_gate(state, input, params);
    EXPECT_NEAR(output.wrench.torque_nmm.dot(along), 170.0, 1e-9);
    EXPECT_NEAR(output.wrench.torque_nmm.dot(across), 300.0, 1e-9);
    EXPECT_NE(output.actions & kGateClamp, 0);
  }
}

TEST(GateRoll, SettlesAtTheContinuousTorqueOfItsMotor) {
  const GateParams params;
  GateState state = open_gate();
  GateOutput output;
  for (int i = 0; i < 100000; ++i) output = step_gate(state, wanting(Vec3::Zero(), {0, 0, 170.0}), params);
  EXPECT_NEAR(output.wrench.torque_nmm.z(), params.continuous_roll_nmm, 0.01 * params.continuous_roll_nmm);
  EXPECT_NE(output.actions & kGateContinuous, 0);
  for (int i = 0; i < 100; ++i) output = step_gate(state, wanting(Vec3::Zero(), {170.0, 0, 0}), params);
  EXPECT_NEAR(output.wrench.torque_nmm.x(), 170.0, 1e-9);  // the other motors are cool
}

TEST(GateRoll, HasNoLimitForADeviceWithoutOne) {
  GateParams params;
  params.peak_roll_nmm = params.continuous_roll_nmm = 0.0;
  GateState state = open_gate(params);
  GateOutput output;
  for (int i = 0; i < 50; ++i) output = step_gate(state, wanting(Vec3::Zero(), {0, 0, 400.0}), params);
  EXPECT_NEAR(output.wrench.torque_nmm.z(), 400.0, 1e-9);
}

// --- energy ---

/// A mass with a little dry friction on a spring whose force comes late.
struct LateSpring {
  static constexpr double kMass = 1e-4;  // N s^2/mm, 0.1 kg
  double k_n_per_mm = 1.0;
  int late = 4;
  double x_mm = 1.0;
  double v_mm_per_s = 0.0;
  std::array<double, 16> past{};
  int count = 0;

  double wanted_n(double told_mm) {
    past[static_cast<std::size_t>(count % 16)] = -k_n_per_mm * told_mm;
    const int then = std::max(0, count - late);
    ++count;
    return past[static_cast<std::size_t>(then % 16)];
  }
  /// A period under a constant force, exactly.
  void move(double force_n) {
    const double whole_n = force_n - std::copysign(0.05, v_mm_per_s);
    x_mm += v_mm_per_s * kDt_s + 0.5 * whole_n / kMass * kDt_s * kDt_s;
    v_mm_per_s += whole_n / kMass * kDt_s;
  }
};

TEST(GatePassivity, StabilisesADelayedSpring) {
  LateSpring bare;
  for (int i = 0; i < 1000; ++i) bare.move(bare.wanted_n(bare.x_mm));
  ASSERT_GT(std::abs(bare.x_mm) + std::abs(bare.v_mm_per_s), 1e4) << "must diverge on its own";

  for (int round = 0; round < 14; ++round) {
    const GateParams params;
    GateState state = open_gate();
    LateSpring spring;
    spring.late = round / 2;
    const double count_mm = round % 2 == 0 ? 0.0 : params.count_mm;
    GateInput input = wanting(Vec3::Zero());
    double told_mm = spring.x_mm;
    double fastest_mm_per_s = 0.0;
    double last_mm_per_s = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const double before_mm = told_mm;
      told_mm = count_mm > 0.0 ? count_mm * std::round(spring.x_mm / count_mm) : spring.x_mm;
      input.wanted.force_n = {0, 0, spring.wanted_n(told_mm)};
      input.v_mm_per_s = {0, 0, (told_mm - before_mm) / kDt_s};
      spring.move(step_gate(state, input, params).wrench.force_n.z());
      fastest_mm_per_s = std::max(fastest_mm_per_s, std::abs(spring.v_mm_per_s));
      last_mm_per_s = i < 19000 ? 0.0 : std::max(last_mm_per_s, std::abs(spring.v_mm_per_s));
    }
    // It starts at rest: all it can have is the margin, and a quarter where the delay makes about as much as the
    // greatest damping takes (1.5 periods and `late`: k T = 0.0075 N s/mm).
    const double allowed_mj = (spring.late < 5 ? 1.0 : 1.25) * params.passivity_margin_mj;
    EXPECT_LT(fastest_mm_per_s, std::sqrt(2.0 * allowed_mj / LateSpring::kMass)) << spring.late << " periods late";
    EXPECT_LT(last_mm_per_s, 5.0) << spring.late << " periods late";
    EXPECT_EQ(state.fault, telemetry::GateFault::kNone);
  }
}

TEST(GatePassivity, DoesNotDampAPassiveSpring) {
  Random random(7);
  for (int round = 0; round < 40; ++round) {
    const double count_mm = round < 20 ? 0.0 : 0.0295;  // of the encoder
    GateState state = open_gate();
    const double k = random.uniform(0.3, 2.0);
    const double reach_mm = random.uniform(1.0, 8.0) / k;
    const double omega = random.uniform(2.0, 12.0);
    double before_mm = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const double true_mm = -0.5 * reach_mm * (1.0 - std::cos(omega * i * kDt_s));
      const double x_mm = count_mm > 0.0 ? count_mm * std::round(true_mm / count_mm) : true_mm;
      const double v = (x_mm - before_mm) / kDt_s;
      before_mm = x_mm;
      GateInput input = wanting({0, 0, -k * x_mm - 0.003 * k * v});
      input.v_mm_per_s = {0, 0, v};
      const GateOutput output = step_gate(state, input, {});
      const double allowed_n = 0.01 * std::abs(input.wanted.force_n.z()) + 1e-9;
      ASSERT_NEAR(output.wrench.force_n.z(), input.wanted.force_n.z(), allowed_n)
          << "round " << round << " period " << i;
    }
  }
}

TEST(GatePassivity, ForgetsDissipatedEnergyWhenTheForceEnds) {
  const GateParams params;
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 3});
  input.v_mm_per_s = {0, 0, -50};
  for (int i = 0; i < 2000; ++i) step_gate(state, input, params);  // 300 mJ of friction
  input.wanted = {};
  step_gate(state, input, params);
  EXPECT_NEAR(state.energy_mj, -params.passivity_margin_mj, 1e-12);
}

TEST(GatePassivity, ForgetsExcessEnergyLongAfterTheForceEnds) {
  const GateParams params;
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 1});
  input.v_mm_per_s = {0, 0, 100};
  for (int i = 0; i < 100; ++i) step_gate(state, input, params);
  input.wanted = {};
  for (int i = 0; i < 240; ++i) step_gate(state, input, params);
  EXPECT_GE(state.energy_mj, 0.5 * params.passivity_margin_mj) << "a swing through zero forgets nothing";
  for (int i = 0; i < 11; ++i) step_gate(state, input, params);
  EXPECT_LE(state.energy_mj, 0.0);
}

TEST(GatePassivity, ExcludesTheCompensatedWeight) {
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 1});  // across the motion: no work
  input.weight = {{0, -0.5, 0}, {10, 0, 0}};
  input.v_mm_per_s = {0, -100, 0};
  input.w_rad_per_s = {1, 0, 0};
  for (int i = 0; i < 500; ++i) {
    const GateOutput output = step_gate(state, input, {});
    ASSERT_NEAR(state.energy_mj, 0.0, 1e-9);
    ASSERT_FALSE(output.actions & kGatePassivity);
  }
}

TEST(GatePassivity, LimitsDampingToTheDevice) {
  const GateParams params;
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 3}, {0, 20, 0});
  input.v_mm_per_s = {0, 0, 200};
  input.w_rad_per_s = {0, 2, 0};
  for (int i = 0; i < 200; ++i) {
    const GateOutput output = step_gate(state, input, params);
    if (i < 100) continue;
    EXPECT_TRUE(output.actions & kGatePassivity);
    EXPECT_NEAR(output.wrench.force_n.z(), 3.0 - params.max_damping_ns_per_mm * 200.0, 1e-9);
    EXPECT_LT(output.wrench.torque_nmm.y(), 20.0);
  }
}

// --- speed ---

TEST(GateBrake, AppliesOnlyDampingAboveItsSpeedThenFaults) {
  const GateParams params;
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 5});
  for (int i = 0; i < 5; ++i) step_gate(state, input, params);
  input.v_mm_per_s = {0, 0, 1500};
  input.weight.force_n = {0, -0.5, 0};
  const int periods = static_cast<int>(std::lround(params.max_runaway_s / kDt_s));
  for (int i = 1; i <= periods; ++i) {
    const GateOutput output = step_gate(state, input, params);
    EXPECT_TRUE(output.actions & kGateBrake);
    if (i <= 2) continue;  // the turn
    EXPECT_LT((output.wrench.force_n - Vec3(0, 0, -params.brake_ns_per_mm * 1500.0)).norm(), 1e-9);
    EXPECT_EQ(state.fault, telemetry::GateFault::kNone) << "period " << i;
  }
  step_gate(state, input, params);
  EXPECT_EQ(state.fault, telemetry::GateFault::kRunaway);
  input.is_reset = true;
  step_gate(state, input, params);
  EXPECT_EQ(state.fault, telemetry::GateFault::kRunaway) << "still too fast";
  input.v_mm_per_s = Vec3::Zero();
  step_gate(state, input, params);
  EXPECT_EQ(state.fault, telemetry::GateFault::kNone);
}

TEST(GateBrake, CountsASwingThroughStandstill) {
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 1});
  for (int i = 0; i < 2000 && state.fault == telemetry::GateFault::kNone; ++i) {
    input.v_mm_per_s = {0, 0, 4000.0 * std::sin(0.3 * i)};  // 84 % of the time above the brake's speed
    step_gate(state, input, {});
  }
  EXPECT_EQ(state.fault, telemetry::GateFault::kRunaway);
}

TEST(GateBrake, DoesNotFaultWithoutForce) {
  GateState state;
  GateInput input;
  input.v_mm_per_s = {3000, 0, 0};
  for (int i = 0; i < 500; ++i) step_gate(state, input, {});
  EXPECT_EQ(state.fault, telemetry::GateFault::kNone);
}

// --- saturation ---

TEST(GateClamp, KeepsAxialForceAndTheLateralRatio) {
  const GateParams params;
  GateState state = open_gate();
  const GateInput input = wanting({30, 0, 30}, {0, 200, 0});
  GateOutput output;
  for (int i = 0; i < 20; ++i) output = step_gate(state, input, params);
  EXPECT_TRUE(output.actions & kGateClamp);
  EXPECT_NEAR(output.wrench.force_n.z(), 30.0, 1e-6);
  EXPECT_NEAR(force_n(output), params.peak_force_n, 1e-6);
  EXPECT_NEAR(output.wrench.torque_nmm.y() / output.wrench.force_n.x(), 200.0 / 30.0, 1e-6);
}

TEST(GateClamp, KeepsLateralForceWhenAxialForceSaturates) {
  const GateParams params;
  GateState state = open_gate();
  GateOutput output;
  for (int i = 0; i < 20; ++i) output = step_gate(state, wanting({2, 0, 80}, {0, 100, 0}), params);
  EXPECT_NEAR(force_n(output), params.peak_force_n, 1e-6);
  EXPECT_NEAR(output.wrench.force_n.x(), 2.0, 1e-6);
  EXPECT_NEAR(output.wrench.torque_nmm.y(), 100.0, 1e-6);
  EXPECT_GT(output.wrench.force_n.z(), 0.979 * params.peak_force_n);
}

TEST(GateClamp, IsContinuousIntoSaturation) {
  GateParams params;
  params.continuous_force_n = params.peak_force_n;  // warmth is another matter
  constexpr double kGain = 5.0;  // of the clamp: sqrt(1 - 0.2^2)/0.2, where it leaves the room across
  constexpr int kSteps = 3000;
  for (const double across_n : {0.0, 0.01, 1.0, 10.0, 40.0}) {
    GateState state = open_gate(params);
    Wrench last;
    for (int i = 0; i < kSteps; ++i) {
      const double s = static_cast<double>(i) / kSteps;
      const GateOutput output = step_gate(state, wanting({across_n * s, 0, 60.0 * s}, {0, 150.0 * s, 0}), params);
      ASSERT_LT((output.wrench.force_n - last.force_n).norm(), kGain * std::hypot(across_n, 60.0) / kSteps);
      ASSERT_LT((output.wrench.torque_nmm - last.torque_nmm).norm(), 2.0 * kGain * 150.0 / kSteps);
      last = output.wrench;
    }
  }
}

TEST(GateClamp, ZeroesTorqueForADeviceWithoutIt) {
  GateParams params;
  params.peak_torque_nmm = 0.0;
  GateState state = open_gate(params);
  GateOutput output;
  for (int i = 0; i < 10; ++i) output = step_gate(state, wanting({0, 0, 3}, {100, 0, 0}), params);
  EXPECT_EQ(output.wrench.torque_nmm, Vec3::Zero().eval());
  EXPECT_DOUBLE_EQ(output.wrench.force_n.z(), 3.0);
  EXPECT_EQ(output.actions, 0);
}

}  // namespace
}  // namespace trocar::haptics
