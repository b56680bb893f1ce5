// Every way back to forces goes through the safe start: no period brings more than a small step.
#include <gtest/gtest.h>

#include "server/test/servo_rig.h"

namespace trocar::server {
namespace {

using testing::needle_at_depth;
using testing::ServoRig;

constexpr double kLargestStep_n = 0.1;  // 5 N within the half second of the safe start are 0.01 N a period

/// A rig that presses the skin with force on.
class Return : public ::testing::Test {
 protected:
  void SetUp() override {
    rig.start();
    rig.move_to(3.0, 10.0);
    pressed_n = rig.hold(0.5).back().written_D.force_n.norm();
    ASSERT_GT(pressed_n, 1.0);
  }
  /// The hand relaxes, so that the safe start can begin, and presses again.
  void expect_soft_return() {
    rig.largest_rise_n = 0.0;
    rig.hold(0.6);
    EXPECT_LT(rig.largest_rise_n, kLargestStep_n) << "still pressed";
    rig.move_to(-10.0, 50.0);
    rig.hold(1.5);
    rig.move_to(3.0, 10.0);
    rig.hold(0.5);
    EXPECT_LT(rig.largest_rise_n, kLargestStep_n);
    EXPECT_EQ(rig.servo.mode(), telemetry::GateMode::kOn);
  }
  void reset() {
    rig.input.is_reset = true;
    rig.step();
  }

  ServoRig rig;
  double pressed_n = 0.0;
};

TEST_F(Return, IsSoftAfterALease) {
  rig.input.is_wanted = false;
  int periods = 0;
  while (rig.servo.gives_force() && periods < 1000) {
    rig.step();
    ++periods;
  }
  EXPECT_LE(periods, 210) << "the forces fade before the device is leased";
  rig.device.reading.X_DS = needle_at_depth(8.0);  // it was moved meanwhile, and deeper
  rig.depth = 8.0;
  rig.last_n = 0.0;
  rig.servo.resume();
  rig.input.is_wanted = true;
  rig.input.now_s += 1.5;
  EXPECT_EQ(rig.step().sample.gate_fault, telemetry::GateFault::kNone)
      << "a pose before the lease is no part of its way";
  expect_soft_return();
}

TEST_F(Return, IsSoftAfterALeaseTakenUnderForce) {
  rig.servo.resume();
  rig.last_n = 0.0;  // whoever had it has written zero
  expect_soft_return();
}

TEST_F(Return, IsSoftAfterALostDevice) {
  rig.device.reading.status = devices::DeviceStatus::kDisconnected;
  for (int i = 0; i < 50; ++i) rig.step();
  EXPECT_EQ(rig.last_n, 0.0);
  rig.servo.resume();  // the control thread has opened it again
  rig.device.reading.status = devices::DeviceStatus::kFresh;
  EXPECT_EQ(rig.hold(0.2).back().sample.gate_fault, telemetry::GateFault::kDeviceLost) << "until the reset";
  reset();
  expect_soft_return();
}

TEST_F(Return, IsSoftAfterAFaultReset) {
  rig.input.busy_s = rig.input.dt_s = 0.06;
  EXPECT_EQ(rig.step().sample.gate_fault, telemetry::GateFault::kLoopSlow);
  rig.input.dt_s = 0.001;
  rig.input.busy_s = 0.0;
  rig.hold(0.5);
  EXPECT_EQ(rig.last_n, 0.0);
  reset();
  expect_soft_return();
}

TEST_F(Return, IsSoftWithAnotherScene) {
  auto other = rig.builder.load(testing::layered_request("proxy"));
  ASSERT_TRUE(other);
  rig.input.scene = &*other;
  rig.largest_rise_n = 0.0;
  rig.hold(0.6);
  EXPECT_LT(rig.largest_rise_n, kLargestStep_n);
  EXPECT_LT(rig.last_n, 0.7) << "found inside: little more than the stylus' weight";
}

TEST_F(Return, IsSoftAfterStoppedForces) {
  rig.input.is_wanted = false;
  rig.hold(0.5);
  EXPECT_EQ(rig.last_n, 0.0);
  rig.input.is_wanted = true;
  expect_soft_return();
}

TEST_F(Return, IsSoftAfterASilentClient) {
  rig.input.silence_s = 1.0;
  rig.hold(0.5);
  EXPECT_EQ(rig.last_n, 0.0);
  rig.input.silence_s = 0.0;
  rig.largest_rise_n = 0.0;
  rig.hold(1.0);
  EXPECT_LT(rig.largest_rise_n, kLargestStep_n);
}

TEST_F(Return, IsSoftAfterTheStylusIsPlaced) {
  link::HandTarget put;
  put.X_PN = rig.scene.scene->X_PW * needle_at_depth(6.0) * rig.scene.scene->X_SN;
  put.is_placed = put.is_rigid = true;
  rig.input.hand = put;
  rig.step();
  rig.depth = 6.0;
  rig.largest_rise_n = 0.0;
  rig.hold(0.6);
  EXPECT_LT(rig.largest_rise_n, kLargestStep_n);
}

}  // namespace
}  // namespace trocar::server
