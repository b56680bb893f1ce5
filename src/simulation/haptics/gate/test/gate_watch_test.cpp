#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/files/folders.h"
#include "core/random.h"
#include "haptics/gate/gate_params.h"
#include "haptics/gate/gate_stages.h"
#include "haptics/gate/test/gate_rig.h"
#include "haptics/test/tick_period.h"

namespace trocar::haptics {
namespace {

using testing::kDt_s;
using testing::open_gate;
using testing::wanting;

/// Growth a period of a mass with viscosity on a coupling whose force is held for a period and one period late, in the
/// last half of many periods: above 1 it swings up. Exact for a constant force.
double growth_a_period(const stylus::CouplingParams& coupling, double share, double period_s, double mass,
                       double viscosity) {
  constexpr int kPeriods = 3000;
  const double a = viscosity / mass, e = std::exp(-a * period_s);
  const double way_of_v = (1.0 - e) / a, way_of_f = (period_s - way_of_v) / viscosity, v_of_f = (1.0 - e) / viscosity;
  double x = 1.0, v = 0.0, x1 = 1.0, x2 = 1.0, grown = 0.0;
  for (int i = 0; i < kPeriods; ++i) {
    const double force =
        -share * (coupling.stiffness_n_per_mm * x1 + coupling.damping_ns_per_mm * (x1 - x2) / period_s);
    const double next_x = x + way_of_v * v + way_of_f * force;
    v = e * v + v_of_f * force;
    x2 = x1;
    x1 = x;
    x = next_x;
    const double size = std::max({std::abs(x), std::abs(v) * period_s, std::abs(x1), std::abs(x2)});
    if (i >= kPeriods / 2) grown += std::log(size);
    x /= size, v /= size, x1 /= size, x2 /= size;
  }
  return std::exp(grown / (kPeriods - kPeriods / 2));
}

TEST(GateLoop, WeakenedCouplingIsStableAtAnyPeriod) {
  const auto presets = stylus::load_device_presets(data_dir() / "devices.toml");
  ASSERT_TRUE(presets);
  constexpr double kPhase = 5e-4;  // where in its swing the mass is measured: a factor of 2 over 1500 periods
  int weakened = 0;
  for (const stylus::DevicePreset& preset : *presets) {
    if (!preset.has_force()) continue;
    const GateParams params = gate_params(preset);
    const double scale = preset.force_scale * preset.motion_scale;
    const stylus::CouplingParams coupling{scale * preset.coupling.stiffness_n_per_mm,
                                          scale * preset.coupling.damping_ns_per_mm};
    // A held device is heavier and damped more: this is the hand of which only b_p is left.
    const double held = params.physical_damping_ns_per_mm + 0.001;
    for (int period_ms = 1; period_ms <= 1000; period_ms += period_ms < 60 ? 1 : 47) {
      const double period_s = 1e-3 * period_ms;
      const bool is_late = period_s > longest_period_s(coupling, params);
      const double share = is_late ? permitted_share(coupling, period_s, params) : 1.0;
      weakened += share < 1.0 ? 1 : 0;
      for (const double mass : {0.7, 1.0, 2.5}) {
        const double growth = growth_a_period(coupling, share, period_s, 1e-3 * mass * preset.apparent_mass_kg, held);
        EXPECT_LE(growth, 1.0 + kPhase) << preset.name << ", " << period_ms << " ms, mass x" << mass << ", share "
                                        << share;
      }
    }
  }
  EXPECT_GT(weakened, 300);
}

TEST(GateLoop, FullCouplingIsUnstableInTheSameLoops) {
  const stylus::CouplingParams premium;
  for (const double period_s : {0.009, 0.013, 0.021, 0.051})
    EXPECT_GT(growth_a_period(premium, 1.0, period_s, 1e-4, 0.0045), 1.15) << period_s;
}

TEST(GateLoop, ShareIsOneUpToTheLongestPeriodThenFalls) {
  const GateParams params;
  for (const stylus::CouplingParams& coupling :
       {stylus::CouplingParams{}, stylus::CouplingParams{0.5, 0.0015}, stylus::CouplingParams{1.0, 0.0}}) {
    const double longest_s = longest_period_s(coupling, params);
    EXPECT_NEAR(permitted_share(coupling, longest_s, params), 1.0, longest_s < 0.01 ? 1e-9 : 1.0);
    double before = 1.0;
    for (double period_s = 0.001; period_s < 1.0; period_s *= 1.02) {
      const double share = permitted_share(coupling, period_s, params);
      EXPECT_LE(share, before);
      EXPECT_GT(share, 0.85 * before);
      before = share;
    }
  }
  EXPECT_EQ(permitted_share({0.0, 0.0}, 10.0, params), 1.0) << "no spring, no harm";
}

TEST(GateLoop, FallsAtOnceAndRecoversWithinTheRiseTime) {
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 3});
  for (int i = 0; i < 10; ++i) step_gate(state, input, {});
  input.dt_s = 0.012;
  input.busy_s = 0.011;
  GateOutput output = step_gate(state, input, {});
  const double share = permitted_share(input.coupling, 0.012, {});
  EXPECT_NEAR(output.wrench.force_n.z(), 3.0 * share, 1e-9);
  EXPECT_TRUE(output.actions & kGateSlowLoop);
  input.dt_s = kDt_s;
  input.busy_s = 0.0;
  double last_n = output.wrench.force_n.z();
  int periods = 0;
  for (; last_n < 3.0 && periods < 1000; ++periods) {
    const double now_n = step_gate(state, input, {}).wrench.force_n.z();
    EXPECT_LE(now_n, last_n + 3.0 * kDt_s / GateParams{}.rise_s + 1e-9);
    last_n = now_n;
  }
  EXPECT_NEAR(periods, 50 + 500 * (1.0 - share), 15) << "50 ms of good periods, then the ramp";
  EXPECT_EQ(state.fault, telemetry::GateFault::kNone);
}

/// The number of late periods to the fault, or 0.
int periods_to_fault(double period_s, double busy_s) {
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 3});
  for (int i = 0; i < 10; ++i) step_gate(state, input, {});
  input.dt_s = period_s;
  input.busy_s = busy_s;
  for (int i = 1; i <= 200; ++i) {
    step_gate(state, input, {});
    if (state.fault == telemetry::GateFault::kLoopSlow) return i;
  }
  return 0;
}

TEST(GateLoop, LatchesWithinFiftyMilliseconds) {
  for (const double period_s : {0.005, 0.006, 0.009, 0.013, 0.021, 0.026, 0.031, 0.045, 0.05, 0.051, 0.09, 0.2, 1.0}) {
    const int own = periods_to_fault(period_s, period_s - 0.001);
    ASSERT_GT(own, 0) << period_s;
    EXPECT_LE(own * period_s, std::max(0.05, period_s) + 1e-9) << period_s;
    const int starved = periods_to_fault(period_s, 0.0001);
    EXPECT_EQ(starved, static_cast<int>(std::ceil(0.05 / period_s - 1e-9))) << period_s;
  }
  EXPECT_EQ(periods_to_fault(0.004, 0.0039), 0) << "a server of 250 Hz";
}

TEST(GateLoop, AFaultStaysWhileTheLoopIsSlow) {
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 0});
  input.dt_s = 0.02;
  input.busy_s = 0.019;
  for (int i = 0; i < 5; ++i) step_gate(state, input, {});
  ASSERT_EQ(state.fault, telemetry::GateFault::kLoopSlow);
  input.is_reset = true;
  step_gate(state, input, {});
  EXPECT_EQ(state.fault, telemetry::GateFault::kLoopSlow);
  input.dt_s = kDt_s;
  for (int i = 0; i < 150; ++i) step_gate(state, input, {});
  EXPECT_EQ(state.fault, telemetry::GateFault::kNone);
}

TEST(GateLoop, CountsNothingWithoutForceOrMotors) {
  GateState off;
  GateInput input;
  input.dt_s = 0.06;
  for (int i = 0; i < 20; ++i) step_gate(off, input, {});
  EXPECT_EQ(off.fault, telemetry::GateFault::kNone);
  const auto mouse = stylus::load_device_preset(data_dir() / "devices.toml", "mouse");
  ASSERT_TRUE(mouse);
  const GateParams params = gate_params(*mouse);
  GateState shown = open_gate(params);
  input = wanting({0, 0, 1});
  input.coupling = {0.0, 0.0};
  input.dt_s = 0.06;
  for (int i = 0; i < 20; ++i) step_gate(shown, input, params);
  EXPECT_EQ(shown.fault, telemetry::GateFault::kNone);
  EXPECT_EQ(shown.coupling_share, 1.0);
}

// --- motion ---

TEST(GateMotion, FaultsOnAnImpossibleStepInItsPeriod) {
  for (const auto& [step_mm, dt_s, fault] : {std::tuple{2.8, 0.001, telemetry::GateFault::kNone},
                                             std::tuple{3.0, 0.001, telemetry::GateFault::kImpossibleMotion},
                                             std::tuple{100.0, 0.001, telemetry::GateFault::kImpossibleMotion},
                                             std::tuple{60.0, 0.02, telemetry::GateFault::kNone},
                                             std::tuple{70.0, 0.02, telemetry::GateFault::kImpossibleMotion}}) {
    GateState state = open_gate();
    GateInput input = wanting({0, 0, 2});
    step_gate(state, input, {});
    input.dt_s = dt_s;
    input.v_mm_per_s = {step_mm / dt_s, 0, 0};
    const GateOutput output = step_gate(state, input, {});
    EXPECT_EQ(state.fault, fault) << step_mm;
    if (fault == telemetry::GateFault::kNone) continue;
    EXPECT_FALSE(output.actions & kGateBrake);
    EXPECT_LE(output.wrench.force_n.norm(), 2.0);
  }
}

TEST(GateMotion, FaultsOnAnImpossibleTurn) {
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 2});
  input.w_rad_per_s = {0, 0, 1000};
  step_gate(state, input, {});
  EXPECT_EQ(state.fault, telemetry::GateFault::kNone);
  input.w_rad_per_s = {0, 0, 1100};
  step_gate(state, input, {});
  EXPECT_EQ(state.fault, telemetry::GateFault::kImpossibleMotion);
}

// --- vibration ---

/// A gate at force for so long: force and velocity swing with a frequency, the force ahead of the velocity by a phase.
GateState gate_after_swing(double force_n, double speed_mm_per_s, double hz, double phase, double seconds) {
  GateState state = open_gate();
  const int periods = static_cast<int>(seconds / kDt_s);
  for (int i = 0; i < periods && state.fault == telemetry::GateFault::kNone; ++i) {
    const double angle = 2.0 * std::numbers::pi * hz * i * kDt_s;
    GateInput input = wanting({0, 0, force_n * std::sin(angle + phase)});
    // What went out in the last period acted while this way was made.
    input.v_mm_per_s = {0, 0, speed_mm_per_s * std::sin(angle - 2.0 * std::numbers::pi * hz * kDt_s)};
    step_gate(state, input, {});
  }
  return state;
}

TEST(GateVibration, PowerIntoFastMotionIsAFault) {
  for (const double hz : {80.0, 150.0, 250.0}) {
    // 1200 mW; the passivity control, which comes first, takes at most 3 N of the 8.
    EXPECT_EQ(gate_after_swing(8.0, 300.0, hz, 0.0, 1.0).fault, telemetry::GateFault::kVibration) << hz;
  }
}

TEST(GateVibration, IgnoresSpringsDampersAndHands) {
  const double pi = std::numbers::pi;
  EXPECT_EQ(gate_after_swing(2.0, 300.0, 100.0, 0.5 * pi, 2.0).fault, telemetry::GateFault::kNone) << "a spring";
  EXPECT_EQ(gate_after_swing(2.0, 300.0, 100.0, pi, 2.0).fault, telemetry::GateFault::kNone) << "a damper";
  EXPECT_EQ(gate_after_swing(2.0, 40.0, 100.0, 0.0, 2.0).fault, telemetry::GateFault::kNone) << "too weak";
  EXPECT_EQ(gate_after_swing(3.0, 400.0, 3.0, 0.0, 2.0).fault, telemetry::GateFault::kNone) << "a hand that is led";
}

}  // namespace
}  // namespace trocar::haptics
