#include "devices/pointer/spacemouse_device.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "devices/pointer/test/pointer_checks.h"
#include "devices/testing/spacenav_daemon.h"

namespace trocar::devices {
namespace {

using testing::is_gone;
using testing::reads_until;
using testing::SpacenavDaemon;
using testing::wait_until;

constexpr int kFullCounts = static_cast<int>(kCapFull_counts);

stylus::DevicePreset spacemouse() {
  stylus::DevicePreset preset;
  preset.name = "spacemouse";
  preset.workspace_radius_mm = 50.0;
  return preset;
}

std::unique_ptr<HapticDevice> open_cap(const SpacenavDaemon& daemon) {
  auto device = PolledPointer::open(spacemouse(), make_spacemouse_source());
  EXPECT_TRUE(device.has_value()) << device.error().text();
  EXPECT_TRUE(wait_until([&] { return daemon.is_connected(); }));
  return device ? std::move(*device) : nullptr;
}

TEST(SpaceMouseMotion, MapsPushesToDeviceAxes) {
  // Right, up, away.
  EXPECT_NEAR((spacemouse_motion({{kFullCounts, 0, 0, 0, 0, 0}}, 0).v_D - kCapSpeed_mm_per_s * Vec3::UnitX()).norm(), 0,
              1e-9);
  EXPECT_NEAR((spacemouse_motion({{0, kFullCounts, 0, 0, 0, 0}}, 0).v_D - kCapSpeed_mm_per_s * Vec3::UnitZ()).norm(), 0,
              1e-9);
  EXPECT_NEAR((spacemouse_motion({{0, 0, kFullCounts, 0, 0, 0}}, 0).v_D - kCapSpeed_mm_per_s * Vec3::UnitY()).norm(), 0,
              1e-9);
}

TEST(SpaceMouseMotion, MapsTurnsToDeviceAxes) {
  // As libspnav turns an object of OpenGL (x right, y up, z to the viewer): about (rx, ry, -rz).
  EXPECT_GT(spacemouse_motion({{0, 0, 0, kFullCounts, 0, 0}}, 0).w_D.x(), 0.0);
  EXPECT_GT(spacemouse_motion({{0, 0, 0, 0, kFullCounts, 0}}, 0).w_D.z(), 0.0);  // about up
  EXPECT_GT(spacemouse_motion({{0, 0, 0, 0, 0, kFullCounts}}, 0).w_D.y(), 0.0);  // about away
}

TEST(SpaceMouseMotion, RestsInTheDeadZoneAndSaturatesAtFullSpeed) {
  const int rest = static_cast<int>(kCapDeadZone_counts);
  const PointerMotion still = spacemouse_motion({{rest, -rest, rest, -rest, rest, -rest}}, kButtonSecond);
  EXPECT_TRUE(still.v_D.isZero(0.0));
  EXPECT_TRUE(still.w_D.isZero(0.0));
  EXPECT_EQ(still.buttons, kButtonSecond);
  for (const int huge : {std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
    const PointerMotion motion = spacemouse_motion({{huge, huge, huge, huge, huge, huge}}, 0);
    EXPECT_LE(motion.v_D.cwiseAbs().maxCoeff(), kCapSpeed_mm_per_s);
    EXPECT_LE(motion.w_D.cwiseAbs().maxCoeff(), kCapTurning_rad_per_s);
  }
}

TEST(SpaceMouse, ErrorExplainsHowToStartTheDaemon) {
  const auto device = PolledPointer::open(spacemouse(), make_spacemouse_source());
  if (device.has_value()) GTEST_SKIP() << "a real spacenavd runs here";
  EXPECT_NE(device.error().text().find("start spacenavd"), std::string::npos);
}

TEST(SpaceMouse, CapMovesTheStylus) {
  SpacenavDaemon daemon;
  const auto device = open_cap(daemon);
  ASSERT_NE(device, nullptr);
  double now_s = 0.0;
  EXPECT_TRUE(reads_until(*device, now_s, [&](const DeviceReading& r) {
    daemon.push_cap({0, -kFullCounts, 0, 0, 0, 0});  // a real one tells it again and again
    return r.X_DS.p().z() < -3.0;
  }));
  EXPECT_NEAR(device->read(now_s).X_DS.p().head<2>().norm(), 0.0, 1e-9);
}

TEST(SpaceMouse, ReleasesASilentCap) {
  SpacenavDaemon daemon;
  const auto device = open_cap(daemon);
  ASSERT_NE(device, nullptr);
  double now_s = 0.0;
  daemon.push_cap({kFullCounts, 0, 0, 0, 0, 0});
  EXPECT_TRUE(reads_until(*device, now_s, [](const DeviceReading& r) { return r.X_DS.p().x() > 0.0; }));
  double last_mm = 0.0;
  EXPECT_TRUE(reads_until(*device, now_s, [&](const DeviceReading& r) {
    const double moved_mm = r.X_DS.p().x() - last_mm;
    last_mm = r.X_DS.p().x();
    const bool is_at_the_edge = last_mm >= spacemouse().workspace_radius_mm;
    return r.status == DeviceStatus::kFresh && moved_mm == 0.0 && !is_at_the_edge;
  }));
}

TEST(SpaceMouse, ReportsButtons) {
  SpacenavDaemon daemon;
  const auto device = open_cap(daemon);
  ASSERT_NE(device, nullptr);
  double now_s = 0.0;
  daemon.press(0, true);
  daemon.press(1, true);
  EXPECT_TRUE(
      reads_until(*device, now_s, [](const DeviceReading& r) { return r.buttons == (kButtonMain | kButtonSecond); }));
  daemon.press(0, false);
  EXPECT_TRUE(reads_until(*device, now_s, [](const DeviceReading& r) { return r.buttons == kButtonSecond; }));
}

TEST(SpaceMouse, AcceptsAnOlderDaemon) {
  SpacenavDaemon daemon(false);
  const auto device = open_cap(daemon);
  ASSERT_NE(device, nullptr);
  double now_s = 0.0;
  daemon.press(0, true);
  EXPECT_TRUE(reads_until(*device, now_s, [](const DeviceReading& r) { return r.buttons == kButtonMain; }));
}

TEST(SpaceMouse, SkipsMalformedEvents) {
  SpacenavDaemon daemon;
  const auto device = open_cap(daemon);
  ASSERT_NE(device, nullptr);
  double now_s = 0.0;
  constexpr std::size_t kEventBytes = 32;
  daemon.send(std::string(kEventBytes, '\xff'));  // no such kind
  daemon.press(-1, true);
  daemon.press(1'000'000, true);
  daemon.press(0, true);
  EXPECT_TRUE(reads_until(*device, now_s, [](const DeviceReading& r) { return r.buttons == kButtonMain; }));
  daemon.send(std::string(kEventBytes / 2, '\0'));  // half an event, and then no more
  EXPECT_TRUE(reads_until(*device, now_s, is_gone));
  EXPECT_TRUE(device->read(now_s).X_DS.is_finite());
}

TEST(SpaceMouse, ReconnectsAfterUnplugging) {
  SpacenavDaemon daemon;
  const auto device = open_cap(daemon);
  ASSERT_NE(device, nullptr);
  double now_s = 0.0;
  daemon.unplug_device();
  EXPECT_TRUE(reads_until(*device, now_s, is_gone));
  EXPECT_FALSE(device->write({}));
  EXPECT_TRUE(wait_until([&] { return !daemon.is_connected(); }));
  ASSERT_TRUE(device->reconnect().has_value());
  EXPECT_TRUE(reads_until(*device, now_s, [](const DeviceReading& r) { return r.status == DeviceStatus::kFresh; }));
}

TEST(SpaceMouse, ReportsADeadDaemonAsDisconnected) {
  double now_s = 0.0;
  auto daemon = std::make_unique<SpacenavDaemon>();
  const auto device = open_cap(*daemon);
  ASSERT_NE(device, nullptr);
  daemon.reset();
  EXPECT_TRUE(reads_until(*device, now_s, is_gone));
}

TEST(SpaceMouse, ReadAndWriteDoNotAllocate) {
  SpacenavDaemon daemon;
  const auto device = open_cap(daemon);
  ASSERT_NE(device, nullptr);
  daemon.push_cap({kFullCounts, kFullCounts, kFullCounts, kFullCounts, kFullCounts, kFullCounts});
  testing::expect_no_allocation(*device);
}

TEST(SpaceMouse, IsOpenedByItsName) {
  const SpacenavDaemon daemon;
  testing::expect_opened_by_name("spacemouse");
}

}  // namespace
}  // namespace trocar::devices
