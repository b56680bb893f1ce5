#include "devices/simulated/replay_device.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/files/folders.h"
#include "devices/device_spec.h"

namespace trocar::devices {
namespace {

std::vector<Pose> swing(int count) {
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    poses.emplace_back(rotation_from_vector({0.1 * i, 0.0, 0.0}), Vec3(2.0 * i, 1.0, 0.0));
  }
  return poses;
}

TEST(ReplayDevice, ReturnsRecordedPosesBitwiseAtTheirRate) {
  const std::vector<Pose> poses = swing(200);
  ReplayDevice device({}, "x", poses, 1000.0);
  for (int i = 0; i < 200; ++i) {
    const DeviceReading reading = device.read(1234.5 + i * 0.001);
    ASSERT_EQ(reading.X_DS.p(), poses[static_cast<std::size_t>(i)].p()) << i;
    ASSERT_EQ(reading.X_DS.R(), poses[static_cast<std::size_t>(i)].R()) << i;
    ASSERT_EQ(reading.status, DeviceStatus::kFresh);
  }
}

TEST(ReplayDevice, InterpolatesBetweenPoses) {
  ReplayDevice device({}, "x", swing(3), 100.0);
  device.read(0.0);
  const DeviceReading reading = device.read(0.0125);
  EXPECT_NEAR(reading.X_DS.p().x(), 2.5, 1e-9);
  EXPECT_NEAR(rotation_vector(reading.X_DS.R()).x(), 0.125, 1e-9);
}

TEST(ReplayDevice, HoldsTheLastPoseDespiteWrites) {
  ReplayDevice device({}, "x", swing(3), 100.0);
  device.read(0.0);
  EXPECT_TRUE(device.write({Vec3::Constant(5.0), Vec3::Zero()}));
  for (const double time_s : {0.02, 0.5, 1e6}) EXPECT_EQ(device.read(time_s).X_DS.p().x(), 4.0) << time_s;
  EXPECT_EQ(device.read(1e6).status, DeviceStatus::kRepeated);
  EXPECT_TRUE(device.read(std::numeric_limits<double>::quiet_NaN()).X_DS.is_finite());
}

TEST(ReplayDevice, IsOpenedWithPosesOnly) {
  DeviceOptions options;
  options.devices_file = data_dir() / "devices.toml";
  const DeviceSpec spec{"replay", "a.trocar"};
  const auto open = [&] { return open_device(spec, options); };
  EXPECT_FALSE(open());
  options.motion.poses = swing(2);
  const auto device = open();
  ASSERT_TRUE(device) << device.error().text();
  EXPECT_EQ((*device)->name(), "replay:a.trocar");
  options.motion.rate_hz = 0.0;
  EXPECT_FALSE(open());
  options.motion.rate_hz = 1000.0;
  options.motion.poses.push_back(Pose::translation(Vec3::Constant(std::numeric_limits<double>::infinity())));
  EXPECT_NE(open().error().text().find("sample 2"), std::string::npos);
}

}  // namespace
}  // namespace trocar::devices
