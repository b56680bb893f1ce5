#include "haptics/gate/safety_gate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "core/files/folders.h"
#include "core/random.h"
#include "core/testing/allocation_guard.h"
#include "haptics/gate/gate_params.h"
#include "haptics/gate/test/gate_rig.h"
#include "haptics/test/tick_period.h"

namespace trocar::haptics {
namespace {

using testing::force_n;
using testing::kDt_s;
using testing::open_gate;
using testing::wanting;

constexpr double kRounding_n = 1e-9;  // sums of a few hundred steps of a ramp

bool is_within(const Wrench& wrench, const GateParams& params) {
  return wrench.force_n.allFinite() && wrench.torque_nmm.allFinite() && wrench.force_n.norm() <= params.peak_force_n &&
         wrench.torque_nmm.norm() <= params.peak_torque_nmm;
}

bool is_finite(const GateState& state) {
  return state.last.force_n.allFinite() && state.last.torque_nmm.allFinite() && state.watched.force_n.allFinite() &&
         state.watched.torque_nmm.allFinite() && std::isfinite(state.scale + state.energy_mj + state.force_heat) &&
         std::isfinite(state.torque_heat + state.runaway_s + state.drop_from_n + state.drop_s);
}

/// All numbers of an input that may be broken.
std::array<double*, 22> numbers(GateInput& input) {
  std::array<double*, 22> all{};
  std::size_t count = 0;
  for (Vec3* vector : {&input.wanted.force_n, &input.wanted.torque_nmm, &input.weight.force_n, &input.weight.torque_nmm,
                       &input.axis, &input.v_mm_per_s, &input.w_rad_per_s}) {
    for (int i = 0; i < 3; ++i) all[count++] = &(*vector)[i];
  }
  all[count] = &input.dt_s;
  return all;
}

constexpr std::array kBroken{std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(),
                             1e200,
                             -1e200,
                             1.1e6};

TEST(SafetyGate, FadesToZeroAndLatchesOnAnyNonFiniteNumber) {
  const GateParams params;
  const int ramp = static_cast<int>(std::lround(params.fault_ramp_s / kDt_s));
  for (std::size_t i = 0; i < 22; ++i) {
    for (const double broken : kBroken) {
      GateState state = open_gate();
      for (int k = 0; k < 10; ++k) step_gate(state, wanting({0, 0, 3}), params);
      ASSERT_NEAR(state.last.force_n.z(), 3.0, kRounding_n);
      GateInput input = wanting({0, 0, 3});
      *numbers(input)[i] = broken;
      double last = 3.0;
      for (int k = 1; k <= ramp; ++k) {
        const GateOutput output = step_gate(state, input, params);
        EXPECT_NEAR(force_n(output), 3.0 * (ramp - k) / ramp, kRounding_n) << "number " << i << ' ' << broken;
        EXPECT_LT(force_n(output), last);
        EXPECT_TRUE(output.actions & kGateFault);
        EXPECT_TRUE(is_finite(state));
        last = force_n(output);
      }
      EXPECT_EQ(state.last.force_n, Vec3::Zero().eval());
      EXPECT_EQ(state.fault, telemetry::GateFault::kNotFinite);
    }
  }
}

TEST(SafetyGate, AcceptsDenormalNumbersWithoutAFault) {
  const double denormal = std::numeric_limits<double>::denorm_min();
  for (std::size_t i = 0; i < 22; ++i) {
    for (const double small : {denormal, -denormal, 1e-160, 0.0}) {
      GateState state = open_gate();
      GateInput input = wanting({0, 0, 3});
      if (i == 21 && !(small > 0.0)) continue;  // no time at all is a fault
      *numbers(input)[i] = small;
      for (int k = 0; k < 50; ++k) {
        const GateOutput output = step_gate(state, input, {});
        ASSERT_TRUE(is_within(output.wrench, {}));
        ASSERT_TRUE(is_finite(state));
      }
      EXPECT_EQ(state.fault, telemetry::GateFault::kNone);
    }
  }
}

TEST(SafetyGate, FaultsOnAPeriodWithoutTime) {
  for (const double dt_s : {0.0, -0.001}) {
    GateState state = open_gate();
    GateInput input = wanting({0, 0, 1});
    input.dt_s = dt_s;
    step_gate(state, input, {});
    EXPECT_EQ(state.fault, telemetry::GateFault::kNotFinite);
  }
}

TEST(SafetyGate, LimitsTheWrenchForAnyInput) {
  Random random(11);
  for (int round = 0; round < 20000; ++round) {
    GateParams params;
    GateState state;
    GateInput input;
    auto scramble = [&](double& value) {
      const double kind = random.uniform();
      if (kind < 0.3) value = std::bit_cast<double>(random.next());
      if (kind < 0.1) value = kBroken[random.next() % kBroken.size()];
    };
    for (double* number : numbers(input)) scramble(*number);
    for (double* number : {&input.silence_s, &input.unread_s}) scramble(*number);
    input.is_wanted = random.uniform() < 0.8;
    input.is_reset = random.uniform() < 0.5;
    auto* fields = reinterpret_cast<double*>(&params);
    for (std::size_t i = 0; i < sizeof(params) / sizeof(double); ++i) scramble(fields[i]);
    for (double* number : {&state.scale, &state.energy_mj, &state.force_heat, &state.torque_heat, &state.runaway_s,
                           &state.drop_from_n, &state.drop_s, &state.last.force_n[1], &state.watched.torque_nmm[2]})
      scramble(*number);
    state.mode = static_cast<telemetry::GateMode>(random.next() % 9);
    state.fault = static_cast<telemetry::GateFault>(random.next() % 3 == 0 ? random.next() % 9 : 0);
    input.device_fault = static_cast<telemetry::GateFault>(random.next() % 3 == 0 ? random.next() % 9 : 0);
    for (int k = 0; k < 5; ++k) {
      const GateOutput output = step_gate(state, input, params);
      ASSERT_TRUE(output.wrench.force_n.allFinite() && output.wrench.torque_nmm.allFinite());
      const bool has_peak = params.peak_force_n >= 0.1 && params.peak_force_n <= 200.0;
      ASSERT_LE(force_n(output), has_peak ? params.peak_force_n : 0.0) << "round " << round;
      const bool has_torque = params.peak_torque_nmm >= 0.0 && params.peak_torque_nmm <= 5000.0;
      ASSERT_LE(output.wrench.torque_nmm.norm(), has_torque ? params.peak_torque_nmm : 0.0);
      ASSERT_TRUE(is_finite(state)) << "round " << round;
    }
  }
}

/// A gate's parameters, each somewhere in its range.
GateParams any_params(Random& random) {
  GateParams params;
  params.peak_force_n = random.uniform(0.1, 200.0);
  params.peak_torque_nmm = random.uniform() < 0.2 ? 0.0 : random.uniform(0.0, 2000.0);
  params.continuous_force_n = random.uniform(0.05, 1.0) * params.peak_force_n;
  params.continuous_torque_nmm = random.uniform() * params.peak_torque_nmm;
  params.thermal_time_s = random.uniform(0.5, 20.0);
  params.max_damping_ns_per_mm = random.uniform(0.0, 0.1);
  params.passivity_margin_mj = random.uniform(0.0, 50.0);
  params.slew_n_per_s = random.uniform(50.0, 1e5);
  params.stale_s = random.uniform(0.02, 1.0);
  params.fade_s = random.uniform(0.01, 1.0);
  params.rise_s = random.uniform(0.02, 1.0);
  params.small_force_n = random.uniform(0.01, 5.0);
  params.small_torque_nmm = random.uniform(0.1, 200.0);
  params.brake_mm_per_s = random.uniform(100.0, 5000.0);
  params.brake_ns_per_mm = random.uniform(0.0, 0.1);
  params.max_runaway_s = random.uniform(0.001, 1.0);
  return params;
}

Vec3 any_vector(Random& random, double size) {
  const double scale = size * std::pow(random.uniform(), 3.0);
  return {random.uniform(-scale, scale), random.uniform(-scale, scale), random.uniform(-scale, scale)};
}

TEST(SafetyGate, StaysWithinLimitsOverAMillionRandomPeriods) {
  Random random(5);
  int full_periods = 0;
  for (int round = 0; round < 1000; ++round) {
    const GateParams params = any_params(random);
    EXPECT_TRUE(check(params).has_value());
    GateState state;
    GateInput input = wanting(Vec3::Zero());
    for (int i = 0; i < 1000; ++i) {
      if (random.uniform() < 0.2) input.wanted = {any_vector(random, 400.0), any_vector(random, 4000.0)};
      if (random.uniform() < 0.05) input.wanted = {};
      if (random.uniform() < 0.1) input.weight = {any_vector(random, 5.0), any_vector(random, 100.0)};
      if (random.uniform() < 0.1) input.axis = any_vector(random, 1.0).normalized();
      // Steps of the speed that a device can make; now and then one that it cannot.
      const double agility_mm_per_s = random.uniform() < 0.001 ? 2.0 * params.brake_mm_per_s : 300.0;
      input.v_mm_per_s += any_vector(random, agility_mm_per_s) - 0.1 * input.v_mm_per_s;
      input.w_rad_per_s = any_vector(random, 20.0);
      input.dt_s = random.uniform() < 0.02 ? random.uniform(0.0001, 0.3) : kDt_s;
      input.silence_s = random.uniform() < 0.01 ? 2.0 : 0.0;
      input.device_fault = random.uniform() < 0.002 ? telemetry::GateFault::kRequested : telemetry::GateFault::kNone;
      input.is_reset = random.uniform() < 0.05;
      const Vec3 before = state.last.force_n;
      const GateOutput output = step_gate(state, input, params);
      ASSERT_TRUE(is_within(output.wrench, params)) << "round " << round << " period " << i;
      ASSERT_TRUE(is_finite(state));
      ASSERT_LE(force_n(output), before.norm() + params.slew_n_per_s * std::min(input.dt_s, 0.005) + kRounding_n);
      full_periods += force_n(output) > 0.99 * params.peak_force_n ? 1 : 0;
    }
  }
  EXPECT_GT(full_periods, 1000) << "the sweep never came near the limits";
}

TEST(SafetyGate, NeverAllocatesAndIsDeterministic) {
  for (int pass = 0; pass < 2; ++pass) {
    GateState a, b;
    Random random(17);
    testing::AllocationGuard guard;
    bool is_same = true;
    for (int i = 0; i < 5000; ++i) {
      GateInput input = wanting(any_vector(random, 60.0));
      if (i < 600) input.wanted = {};
      input.v_mm_per_s = any_vector(random, 1500.0);
      if (i == 4000) input.v_mm_per_s.x() = std::numeric_limits<double>::quiet_NaN();
      const GateOutput x = step_gate(a, input, {});
      const GateOutput y = step_gate(b, input, {});
      is_same = is_same && x.wrench.force_n == y.wrench.force_n && x.actions == y.actions && a.energy_mj == b.energy_mj;
    }
    EXPECT_EQ(guard.count(), 0u);
    EXPECT_TRUE(is_same);
  }
}

TEST(SafetyGate, PassesAnOrdinaryForceUnchanged) {
  GateState state = open_gate();
  for (int i = 0; i < 1000; ++i) {
    GateInput input = wanting({0.5, 0.2 * std::sin(0.01 * i), 3.0 + std::cos(0.02 * i)});
    input.wanted.torque_nmm = {20.0 * std::sin(0.02 * i), 5.0, 0.0};
    input.weight.force_n = {0.0, -0.5, 0.0};
    const GateOutput output = step_gate(state, input, {});
    if (i < 2) continue;  // the first rise
    EXPECT_EQ(output.wrench.force_n, (input.wanted.force_n + input.weight.force_n).eval());
    EXPECT_EQ(output.wrench.torque_nmm, input.wanted.torque_nmm);
    EXPECT_EQ(output.actions, 0);
  }
}

TEST(SafetyGate, WaitsForASmallForceWhenStartedInsideTissue) {
  const GateParams params;
  GateState state;
  GateInput input = wanting({0, 0, 3});
  input.weight.force_n = {0, -0.5, 0};
  for (int i = 0; i < 3000; ++i) {
    const GateOutput output = step_gate(state, input, params);
    ASSERT_EQ(force_n(output), 0.0);
    ASSERT_TRUE(output.actions & kGateStart);
  }
  EXPECT_EQ(state.mode, telemetry::GateMode::kWaiting);
  input.wanted.force_n = {0, 0, 0.2};
  input.wanted.torque_nmm = {30, 0, 0};  // still too much
  step_gate(state, input, params);
  EXPECT_EQ(state.mode, telemetry::GateMode::kWaiting);
  input.wanted.torque_nmm = Vec3::Zero();
  step_gate(state, input, params);
  EXPECT_EQ(state.mode, telemetry::GateMode::kRising);
  input.wanted.force_n = {0, 0, 3};
  const double whole = Vec3(0, -0.5, 3).norm();
  const int periods = static_cast<int>(std::lround(params.rise_s / kDt_s));
  for (int i = 2; i <= periods; ++i) EXPECT_NEAR(force_n(step_gate(state, input, params)), whole * i / periods, 1e-9);
  EXPECT_EQ(state.mode, telemetry::GateMode::kOn);
}

TEST(SafetyGate, IsAtZeroExactlyAfterSilenceAndFade) {
  const GateParams params;
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 3});
  for (int ms = 1; ms <= 600; ++ms) {
    input.silence_s = ms * kDt_s;
    const GateOutput output = step_gate(state, input, params);
    EXPECT_NEAR(force_n(output), 3.0 * std::clamp((450 - ms) / 200.0, 0.0, 1.0), ms < 450 ? kRounding_n : 0.0);
    EXPECT_EQ((output.actions & kGateStale) != 0, ms > 250);
  }
  EXPECT_EQ(state.mode, telemetry::GateMode::kFading);
  input.silence_s = 0.0;
  double last = 0.0;
  for (int ms = 1; ms <= 500; ++ms) {
    const double now = force_n(step_gate(state, input, params));
    EXPECT_NEAR(now - last, 3.0 * kDt_s / params.rise_s, kRounding_n);
    last = now;
  }
  EXPECT_EQ(state.mode, telemetry::GateMode::kOn);
}

TEST(SafetyGate, ResumesFromTheMiddleOfAFadeWithoutAJump) {
  const GateParams params;
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 3});
  step_gate(state, input, params);
  input.silence_s = 0.3;
  for (int i = 0; i < 100; ++i) step_gate(state, input, params);
  EXPECT_NEAR(state.last.force_n.z(), 1.5, kRounding_n);
  input.silence_s = 0.0;
  EXPECT_NEAR(force_n(step_gate(state, input, params)), 1.5 + 3.0 * kDt_s / params.rise_s, kRounding_n);
}

TEST(SafetyGate, SilenceNeverSkipsTheSafeStart) {
  GateState state;
  GateInput input = wanting({0, 0, 3});
  for (int i = 0; i < 2000; ++i) {
    input.silence_s = (i / 500) % 2 == 0 ? 0.0 : 1.0;
    ASSERT_EQ(force_n(step_gate(state, input, {})), 0.0);
  }
  EXPECT_EQ(state.mode, telemetry::GateMode::kWaiting);
}

TEST(SafetyGate, FadesToOffWithoutARequestForForces) {
  const GateParams params;
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 3});
  step_gate(state, input, params);
  input.is_wanted = false;
  for (int ms = 1; ms < 200; ++ms)
    EXPECT_NEAR(force_n(step_gate(state, input, params)), 3.0 * (200 - ms) / 200.0, kRounding_n);
  const GateOutput output = step_gate(state, input, params);
  EXPECT_EQ(force_n(output), 0.0);
  EXPECT_TRUE(output.actions & kGateOff);
  input.is_wanted = true;
  step_gate(state, input, params);
  EXPECT_EQ(state.mode, telemetry::GateMode::kWaiting) << "after off comes a safe start";
}

TEST(SafetyGate, LatchesAFaultUntilAResetAfterItsCauseEnds) {
  using Break = std::function<void(GateInput&)>;
  const std::array<std::pair<telemetry::GateFault, Break>, 5> causes{{
      {telemetry::GateFault::kDeviceLost,
       [](GateInput& input) { input.device_fault = telemetry::GateFault::kDeviceLost; }},
      {telemetry::GateFault::kEncoderStuck,
       [](GateInput& input) { input.device_fault = telemetry::GateFault::kEncoderStuck; }},
      {telemetry::GateFault::kRequested,
       [](GateInput& input) { input.device_fault = telemetry::GateFault::kRequested; }},
      {telemetry::GateFault::kDeviceSilent, [](GateInput& input) { input.unread_s = 0.021; }},
      {telemetry::GateFault::kNotFinite, [](GateInput& input) { input.wanted.force_n.x() = std::nan(""); }},
  }};
  for (const auto& [fault, break_it] : causes) {
    GateState state = open_gate();
    GateInput broken = wanting({0, 0, 3});
    break_it(broken);
    for (int i = 0; i < 40; ++i) step_gate(state, broken, {});
    EXPECT_EQ(state.fault, fault);
    broken.is_reset = true;
    step_gate(state, broken, {});
    EXPECT_EQ(state.fault, fault) << "the cause lasts";
    GateInput healthy = wanting({0, 0, 3});
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(force_n(step_gate(state, healthy, {})), 0.0);
    EXPECT_EQ(state.fault, fault) << "nobody has reset it";
    healthy.is_reset = true;
    ASSERT_EQ(force_n(step_gate(state, healthy, {})), 0.0);
    EXPECT_EQ(state.fault, telemetry::GateFault::kNone);
    EXPECT_EQ(state.mode, telemetry::GateMode::kWaiting);
  }
}

TEST(SafetyGate, KeepsTheFirstFault) {
  GateState state = open_gate();
  GateInput input = wanting({0, 0, 3});
  input.unread_s = 1.0;
  step_gate(state, input, {});
  input.device_fault = telemetry::GateFault::kDeviceLost;
  input.v_mm_per_s.x() = std::nan("");
  for (int i = 0; i < 10; ++i) step_gate(state, input, {});
  EXPECT_EQ(state.fault, telemetry::GateFault::kDeviceSilent);
}

TEST(SafetyGate, NamesUnusableParameters) {
  EXPECT_TRUE(check(GateParams{}).has_value());
  GateParams params;
  params.slew_n_per_s = std::nan("");
  const Status status = check(params);
  ASSERT_FALSE(status.has_value());
  EXPECT_NE(status.error().text().find("slew_n_per_s"), std::string::npos);
  params = {};
  params.continuous_force_n = params.peak_force_n + 1.0;
  EXPECT_FALSE(check(params).has_value());
}

TEST(SafetyGate, HasUsableParametersForEveryDevice) {
  const auto presets = stylus::load_device_presets(data_dir() / "devices.toml");
  ASSERT_TRUE(presets.has_value());
  ASSERT_FALSE(presets->empty());
  for (const stylus::DevicePreset& preset : *presets) {
    const GateParams params = gate_params(preset);
    EXPECT_TRUE(check(params).has_value()) << preset.name;
    EXPECT_EQ(params.peak_force_n, preset.capability.peak_force_n);
    EXPECT_LE(params.brake_ns_per_mm, params.max_damping_ns_per_mm);
    EXPECT_EQ(params.continuous_force_n, preset.continuous_force_n.value_or(params.continuous_force_n));
  }
}

}  // namespace
}  // namespace trocar::haptics
