#include "devices/simulated/faulty_device.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/files/folders.h"
#include "core/testing/allocation_guard.h"
#include "devices/device_spec.h"
#include "devices/simulated/replay_device.h"

namespace trocar::devices {
namespace {

constexpr double kForEver = std::numeric_limits<double>::infinity();

/// Moves by 1 mm a read; remembers what was written.
class Mover final : public HapticDevice {
 public:
  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return "mover"; }
  DeviceReading read(double) noexcept override {
    DeviceReading reading;
    reading.status = is_gone ? DeviceStatus::kDisconnected : DeviceStatus::kFresh;
    reading.X_DS = Pose::translation({static_cast<double>(reads_++), 0.0, 0.0});
    return reading;
  }
  bool write(const Wrench& wrench_D) noexcept override {
    written = wrench_D;
    ++writes;
    return true;
  }
  void hold(const DeviceHand&) noexcept override { ++holds; }
  Status reconnect() override {
    ++reconnects;
    is_gone = false;
    return {};
  }

  Wrench written;
  int writes = 0, holds = 0, reconnects = 0;
  bool is_gone = false;

 private:
  stylus::DevicePreset preset_;
  int reads_ = 0;
};

struct Broken {
  Mover* mover;
  FaultyDevice device;
  explicit Broken(std::vector<ScheduledFault> faults, FaultyDevice::Wait wait = {})
      : Broken(std::make_unique<Mover>(), std::move(faults), wait) {}

 private:
  Broken(std::unique_ptr<Mover> inner, std::vector<ScheduledFault> faults, FaultyDevice::Wait wait)
      : mover(inner.get()), device(std::move(inner), std::move(faults), 7, wait) {}
};

/// Reads at 0, 1, 2 … s after a first read at `start_s`; position along x, which is the number of the read when nothing
/// is broken.
std::vector<DeviceReading> read_seconds(FaultyDevice& device, int count, double start_s = 1e5) {
  std::vector<DeviceReading> readings;
  for (int i = 0; i < count; ++i) readings.push_back(device.read(start_s + i));
  return readings;
}

TEST(FaultyDevice, PassesReadingsThroughOutsideFaults) {
  Broken broken({{DeviceFault::kJump, 3.0, 2.0, 100.0}});
  const auto readings = read_seconds(broken.device, 8);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double jump = i >= 3 && i < 5 ? 100.0 : 0.0;
    EXPECT_EQ(readings[i].X_DS.p().x(), static_cast<double>(i) + jump) << i;
    EXPECT_EQ(readings[i].status, DeviceStatus::kFresh);
  }
  EXPECT_EQ(broken.device.name(), "faulty:mover");
  broken.device.hold({});
  EXPECT_TRUE(broken.device.write({{1.0, 2.0, 3.0}, Vec3::Zero()}));
  EXPECT_EQ(broken.mover->holds, 1);
  EXPECT_EQ(broken.mover->written.force_n, Vec3(1.0, 2.0, 3.0));
}

TEST(FaultyDevice, JitterIsBoundedSeededAndNotConstant) {
  Broken one({{DeviceFault::kJitter, 0.0, kForEver, 0.5}});
  Broken other({{DeviceFault::kJitter, 0.0, kForEver, 0.5}});
  double most = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p_D = one.device.read(i).X_DS.p();
    EXPECT_EQ(p_D, other.device.read(i).X_DS.p());
    const double off = (p_D - Vec3(i, 0.0, 0.0)).cwiseAbs().maxCoeff();
    EXPECT_LE(off, 0.5);
    most = std::max(most, off);
  }
  EXPECT_GT(most, 0.4);
}

TEST(FaultyDevice, DroppedReadsAreMarkedRepeated) {
  Broken broken({{DeviceFault::kDropped, 2.0, 3.0, 0.0}});
  const auto readings = read_seconds(broken.device, 7);
  for (std::size_t i = 2; i < 5; ++i) {
    EXPECT_EQ(readings[i].status, DeviceStatus::kRepeated) << i;
    EXPECT_EQ(readings[i].X_DS.p().x(), 1.0) << i;
  }
  EXPECT_EQ(readings[5].X_DS.p().x(), 5.0);
}

TEST(FaultyDevice, StuckEncoderRepeatsPosesMarkedFresh) {
  Broken broken({{DeviceFault::kStuck, 2.0, 3.0, 0.0}});
  const auto readings = read_seconds(broken.device, 7);
  for (std::size_t i = 2; i < 5; ++i) {
    EXPECT_EQ(readings[i].status, DeviceStatus::kFresh) << i;
    EXPECT_EQ(readings[i].X_DS.p().x(), 1.0) << i;
  }
  EXPECT_EQ(readings[5].X_DS.p().x(), 5.0);
}

TEST(FaultyDevice, NanPosesEndWithTheFault) {
  Broken broken({{DeviceFault::kNan, 2.0, 1.0, 0.0}, {DeviceFault::kDropped, 3.0, 1.0, 0.0}});
  const auto readings = read_seconds(broken.device, 5);
  EXPECT_TRUE(readings[1].X_DS.is_finite());
  EXPECT_TRUE(readings[2].X_DS.p().hasNaN() && readings[2].X_DS.R().hasNaN());
  EXPECT_EQ(readings[3].X_DS.p().x(), 2.0);
  EXPECT_EQ(readings[4].X_DS.p().x(), 4.0);
}

TEST(FaultyDevice, UnpluggedRefusesWritesUntilReopened) {
  Broken broken({{DeviceFault::kDisconnect, 2.0, 2.0, 0.0}});
  broken.device.read(0.0);
  EXPECT_TRUE(broken.device.write({{3.0, 0.0, 0.0}, Vec3::Zero()}));
  EXPECT_EQ(broken.device.read(2.0).status, DeviceStatus::kDisconnected);
  EXPECT_EQ(broken.mover->written.force_n.norm(), 0.0);  // a motor without a plug
  const int writes = broken.mover->writes;
  EXPECT_FALSE(broken.device.write({{3.0, 0.0, 0.0}, Vec3::Zero()}));
  EXPECT_EQ(broken.mover->writes, writes);
  EXPECT_TRUE(broken.device.reconnect());
  EXPECT_EQ(broken.device.read(3.0).status, DeviceStatus::kDisconnected);   // still unplugged
  EXPECT_EQ(broken.device.read(10.0).status, DeviceStatus::kDisconnected);  // nobody opened it
  EXPECT_TRUE(broken.device.reconnect());
  EXPECT_EQ(broken.device.read(11.0).status, DeviceStatus::kFresh);
  EXPECT_TRUE(broken.device.write({}));
  EXPECT_EQ(broken.mover->reconnects, 0);  // nothing was wrong with the device itself
}

TEST(FaultyDevice, StaysClosedWhenUnpluggedForEver) {
  Broken broken({{DeviceFault::kDisconnect, 0.0, kForEver, 0.0}});
  EXPECT_EQ(broken.device.read(0.0).status, DeviceStatus::kDisconnected);
  EXPECT_FALSE(broken.device.reconnect());
}

TEST(FaultyDevice, ReopensADisconnectedDevice) {
  Broken broken({{DeviceFault::kJump, 100.0, 1.0, 1.0}});
  broken.device.read(0.0);
  broken.mover->is_gone = true;
  EXPECT_EQ(broken.device.read(1.0).status, DeviceStatus::kDisconnected);
  EXPECT_TRUE(broken.device.reconnect());
  EXPECT_EQ(broken.mover->reconnects, 1);
  EXPECT_EQ(broken.device.read(2.0).status, DeviceStatus::kFresh);
}

TEST(FaultyDevice, SlowReadsAndWritesWaitAtMostTheMaximum) {
  double waited_ms = 0.0;
  const auto count = [](void* sum, double wait_ms) noexcept { *static_cast<double*>(sum) += wait_ms; };
  Broken broken({{DeviceFault::kSlowRead, 1.0, 1.0, 3.0}, {DeviceFault::kSlowWrite, 2.0, 1.0, 1e9}},
                {count, &waited_ms});
  broken.device.read(0.0);
  EXPECT_TRUE(broken.device.write({}));
  EXPECT_EQ(waited_ms, 0.0);
  broken.device.read(1.0);
  EXPECT_TRUE(broken.device.write({}));
  EXPECT_EQ(waited_ms, 3.0);
  broken.device.read(2.0);
  EXPECT_EQ(waited_ms, 3.0);
  EXPECT_TRUE(broken.device.write({}));
  EXPECT_EQ(waited_ms, 3.0 + kMaxSlow_ms);
}

TEST(FaultyDevice, NeverAllocatesDuringAnyFault) {
  for (const DeviceFault fault :
       {DeviceFault::kJitter, DeviceFault::kDropped, DeviceFault::kNan, DeviceFault::kStuck, DeviceFault::kJump,
        DeviceFault::kDisconnect, DeviceFault::kSlowWrite, DeviceFault::kSlowRead}) {
    Broken broken({{fault, 0.0, kForEver, 0.0}});
    const testing::AllocationGuard guard;
    for (int i = 0; i < 10; ++i) {
      broken.device.read(i);
      broken.device.hold({});
      broken.device.write({});
    }
    EXPECT_EQ(guard.count(), 0u) << to_string(fault);
  }
}

TEST(FaultyDevice, WrapsADeviceOpenedWithASchedule) {
  DeviceOptions options;
  options.devices_file = data_dir() / "devices.toml";
  options.faults = {*parse_fault("nan@0")};
  const auto device = open_device({"virtual", "omni"}, options);
  ASSERT_TRUE(device) << device.error().text();
  EXPECT_EQ((*device)->name(), "faulty:virtual:omni");
  EXPECT_EQ((*device)->preset().name, "omni");
  EXPECT_FALSE((*device)->read(0.0).X_DS.is_finite());
}

}  // namespace
}  // namespace trocar::devices
