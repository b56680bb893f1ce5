#include "devices/pointer/pointer_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace trocar::devices {
namespace {

constexpr double kPointerTick_s = 0.001;

DeviceHand pointing(const Vec3& p_D, double time_s) {
  DeviceHand hand;
  hand.X_DS = Pose::translation(p_D);
  hand.time_s = time_s;
  hand.is_held = true;
  return hand;
}

TEST(PointerDevice, StartsWhereItIsFirstHeld) {
  PointerDevice device({}, {});
  device.read(0.0);
  device.hold(pointing({50.0, 0.0, 0.0}, 0.0));
  EXPECT_EQ(device.read(kPointerTick_s).X_DS.p().x(), 50.0);
}

TEST(PointerDevice, FollowsWithItsTimeConstant) {
  PointerDevice device({}, {});
  device.read(0.0);
  device.hold(pointing(Vec3::Zero(), 0.0));
  device.hold(pointing({4.0, 0.0, 0.0}, 0.0));
  double time_s = 0.0;
  for (int i = 0; i < 20; ++i) device.read(time_s += kPointerTick_s);
  const double once = 4.0 * (1.0 - std::exp(-0.02 / PointerParams{}.time_constant_s));
  EXPECT_NEAR(device.read(time_s).X_DS.p().x(), once, 1e-9);
  PointerDevice slow({}, {});  // and whatever the server's rate
  slow.read(0.0);
  slow.hold(pointing(Vec3::Zero(), 0.0));
  slow.hold(pointing({4.0, 0.0, 0.0}, 0.0));
  for (int i = 1; i <= 4; ++i) slow.read(0.005 * i);
  EXPECT_NEAR(slow.read(0.02).X_DS.p().x(), once, 1e-9);
}

TEST(PointerDevice, NeverMovesOrTurnsFasterThanAHand) {
  const PointerParams params;
  PointerDevice device({}, params);
  device.read(0.0);
  device.hold(pointing(Vec3::Zero(), 0.0));
  DeviceHand far = pointing({300.0, 400.0, 0.0}, 0.0);
  far.X_DS = Pose(rotation_from_vector({0.0, 3.0, 0.0}), far.X_DS.p());
  device.hold(far);
  Pose before = device.read(0.0).X_DS;
  for (int i = 1; i < 3000; ++i) {
    const Pose now = device.read(i * kPointerTick_s).X_DS;
    EXPECT_LE((now.p() - before.p()).norm(), params.max_speed_mm_per_s * kPointerTick_s * (1.0 + 1e-9));
    EXPECT_LE(rotation_vector(now.R() * before.R().transpose()).norm(),
              params.max_turn_rad_per_s * kPointerTick_s + 1e-9);
    before = now;
  }
  EXPECT_LT((before.p() - far.X_DS.p()).norm(), 1e-6);
  EXPECT_LT(rotation_vector(before.R() * far.X_DS.R().transpose()).norm(), 1e-6);
}

TEST(PointerDevice, StaysWhereItIsReleased) {
  PointerDevice device({}, {});
  device.read(0.0);
  device.hold(pointing({10.0, 0.0, 0.0}, 0.0));
  device.hold({});
  for (int i = 1; i < 100; ++i) EXPECT_EQ(device.read(i * kPointerTick_s).X_DS.p().x(), 10.0);
}

TEST(PointerDevice, FollowsPlacementsRigidly) {
  PointerDevice device({}, {});
  device.read(0.0);
  device.hold(pointing(Vec3::Zero(), 0.0));
  DeviceHand placed = pointing({300.0, 0.0, 0.0}, 0.5);
  placed.is_placed = true;
  device.hold(placed);
  EXPECT_EQ(device.read(kPointerTick_s).X_DS.p().x(), 300.0);
  DeviceHand rigid = pointing({-300.0, 0.0, 0.0}, 0.6);
  rigid.is_rigid = true;
  rigid.buttons = kButtonMain;
  device.hold(rigid);
  const DeviceReading reading = device.read(2 * kPointerTick_s);
  EXPECT_EQ(reading.X_DS.p().x(), -300.0);
  EXPECT_EQ(reading.buttons, kButtonMain);
}

TEST(PointerDevice, IgnoresNonFiniteHandsAndTimes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  PointerDevice device({}, {});
  device.read(0.0);
  device.hold(pointing({1.0, 0.0, 0.0}, 0.0));
  device.hold(pointing({nan, 0.0, 0.0}, 0.0));
  EXPECT_EQ(device.read(kPointerTick_s).X_DS.p().x(), 1.0);
  EXPECT_EQ(device.read(nan).status, DeviceStatus::kRepeated);
  EXPECT_EQ(device.read(2 * kPointerTick_s).status, DeviceStatus::kFresh);
}

}  // namespace
}  // namespace trocar::devices
