// A loop of 1 to 1000 ms on every simulated device while a hand moves it in tissue.
#include <gtest/gtest.h>

#include "haptics/gate/gate_params.h"
#include "lab/server/slow_loop_trial.h"
#include "server/test/servo_rig.h"

namespace trocar::server {
namespace {

constexpr std::array kSlow_ms{1.0, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 30.0, 50.0, 100.0, 200.0, 240.0, 400.0, 1000.0};

class SlowLoop : public ::testing::TestWithParam<std::string> {
 protected:
  SlowLoop()
      : preset(testing::device_preset(GetParam().c_str())),
        builder(testing::layered_opener(), testing::data_file("tissues.toml"), preset) {
    const auto made = builder.load(testing::layered_request());
    TROCAR_CHECK(made.has_value());
    scene = *made;
  }
  SlowLoopOutcome run(double slow_ms, devices::DeviceFault fault = devices::DeviceFault::kSlowRead) const {
    SlowLoopTrial trial;
    trial.fault = fault;
    trial.slow_ms = slow_ms;
    return run_slow_loop_trial(scene, preset, trial);
  }
  stylus::CouplingParams coupling() const {
    const double scale = preset.force_scale * preset.motion_scale;
    return {scale * preset.coupling.stiffness_n_per_mm, scale * preset.coupling.damping_ns_per_mm};
  }
  double longest_period_s() const {
    return trocar::haptics::longest_period_s(coupling(), haptics::gate_params(preset));
  }
  double permitted_share(double period_s) const {
    return trocar::haptics::permitted_share(coupling(), period_s, haptics::gate_params(preset));
  }

  stylus::DevicePreset preset;
  SceneBuilder builder;
  ServoScene scene;
};

TEST_P(SlowLoop, ReachesZeroForceWithin50MsAndOnePeriod) {
  const SlowLoopOutcome healthy = run(0.0);
  ASSERT_EQ(healthy.fault, telemetry::GateFault::kNone);
  ASSERT_EQ(healthy.least_share, 1.0);
  ASSERT_GT(healthy.after_n, preset.has_force() ? 0.3 : 0.0) << "there is something to be felt";
  constexpr double kRamp_s = 0.02;
  for (const double slow_ms : kSlow_ms) {
    for (const devices::DeviceFault fault : {devices::DeviceFault::kSlowRead, devices::DeviceFault::kSlowWrite}) {
      SCOPED_TRACE(::testing::Message() << to_string(fault) << ' ' << slow_ms << " ms");
      const SlowLoopOutcome slow = run(slow_ms, fault);
      const double period_s = slow.longest_period_s;
      if (!preset.has_force()) {
        EXPECT_EQ(slow.fault, period_s > 0.25 ? telemetry::GateFault::kLoopStalled : telemetry::GateFault::kNone);
        continue;
      }
      // No swing: a fault takes the force away and leaves the hand alone with the stylus' weight.
      EXPECT_LT(slow.after_n, 1.5 * healthy.after_n + 0.5);
      EXPECT_LT(slow.travel_mm, healthy.travel_mm + 12.0);
      if (period_s <= longest_period_s()) {
        EXPECT_EQ(slow.fault, telemetry::GateFault::kNone);
        EXPECT_EQ(slow.least_share, 1.0);
        continue;
      }
      EXPECT_EQ(slow.fault, period_s > 0.25 ? telemetry::GateFault::kLoopStalled : telemetry::GateFault::kLoopSlow);
      if (permitted_share(period_s) < 1.0) {
        EXPECT_LT(slow.least_share, 1.0);
      }
      EXPECT_LE(slow.latch_s, std::max(0.05, period_s) + 1e-6);
      if (period_s >= 0.05) {
        EXPECT_EQ(slow.latch_periods, 1);
      }
      EXPECT_LE(slow.zero_s, slow.latch_s + kRamp_s + period_s);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryDevice, SlowLoop,
                         ::testing::Values("premium", "omni", "desktop", "omega6", "omega7", "sigma7", "delta6",
                                           "falcon", "inverse3", "mouse", "gamepad", "spacemouse"));

/// The list above is that of the file.
TEST(SlowLoops, CoverEveryDevice) {
  const auto presets = stylus::load_device_presets(testing::data_file("devices.toml"));
  ASSERT_TRUE(presets);
  EXPECT_EQ(presets->size(), 12U) << "a new row of data/devices.toml belongs into EveryDevice";
}

}  // namespace
}  // namespace trocar::server
