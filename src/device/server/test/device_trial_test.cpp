#include "server/device_trial.h"

#include <gtest/gtest.h>

#include "core/testing/allocation_guard.h"
#include "server/test/servo_rig.h"

namespace trocar::server {
namespace {

constexpr double kTrialPeriod_s = 1e-3;

struct Tried {
  double most_n = 0.0, least_up_n = 0.0;
  DeviceTrialRecord last;
};

Tried run(DeviceTrial& trial, double& now_s, double for_s) {
  Tried tried;
  for (const double end_s = now_s + for_s; now_s < end_s; now_s += kTrialPeriod_s) {
    tried.last = trial.step(now_s, kTrialPeriod_s);
    tried.most_n = std::max(tried.most_n, tried.last.written_D.force_n.norm());
    tried.least_up_n = std::min(tried.least_up_n, tried.last.written_D.force_n.z());
  }
  return tried;
}

TEST(DeviceTrial, WritesNoForceWithoutARequest) {
  testing::ScriptedDevice device(testing::device_preset("omni"));
  DeviceTrial trial(device, 1000.0);
  double now_s = 1.0;
  const Tried tried = run(trial, now_s, 1.0);
  EXPECT_EQ(tried.most_n, 0.0);
  EXPECT_EQ(tried.last.fault, telemetry::GateFault::kNone);
}

TEST(DeviceTrial, PushesUpOnceWithinTheDeviceLimit) {
  for (const char* name : {"omni", "premium"}) {
    const stylus::DevicePreset preset = testing::device_preset(name);
    testing::ScriptedDevice device(preset);
    DeviceTrial trial(device, 1000.0);
    EXPECT_LE(trial.push_n(), 1.0);
    EXPECT_LE(trial.push_n(), 0.6 * preset.continuous_force_n.value_or(1e3) + 1e-9);
    double now_s = 1.0;
    run(trial, now_s, 0.1);
    trial.push();
    Tried tried = run(trial, now_s, 3.0);
    EXPECT_NEAR(tried.most_n, trial.push_n(), 0.02 * trial.push_n()) << name;
    EXPECT_GE(tried.least_up_n, 0.0);
    EXPECT_FALSE(tried.last.is_pushing);
    tried = run(trial, now_s, 0.5);
    EXPECT_EQ(tried.most_n, 0.0) << "the push is over";
  }
}

TEST(DeviceTrial, ReportsAnUnpluggedDeviceAndRetriesOnAPush) {
  testing::ScriptedDevice device(testing::device_preset("omni"));
  DeviceTrial trial(device, 1000.0);
  double now_s = 1.0;
  trial.push();
  run(trial, now_s, 0.8);
  device.reading.status = devices::DeviceStatus::kDisconnected;
  Tried tried = run(trial, now_s, 0.1);
  EXPECT_EQ(tried.last.fault, telemetry::GateFault::kDeviceLost);
  EXPECT_EQ(tried.last.written_D.force_n.norm(), 0.0);
  device.reading.status = devices::DeviceStatus::kFresh;
  tried = run(trial, now_s, 1.0);
  EXPECT_EQ(tried.most_n, 0.0) << "nobody asked for a force since";
  trial.push();
  tried = run(trial, now_s, 3.0);
  EXPECT_EQ(tried.last.fault, telemetry::GateFault::kNone);
  EXPECT_GT(tried.most_n, 0.4);
}

TEST(DeviceTrial, NothingIsAllocatedInAPeriod) {
  testing::ScriptedDevice device(testing::device_preset("omni"));
  DeviceTrial trial(device, 1000.0);
  trial.push();
  const testing::AllocationGuard guard;
  trial.step(1.0, kTrialPeriod_s);
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace trocar::server
