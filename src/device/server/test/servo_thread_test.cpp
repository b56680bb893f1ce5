#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "realtime/periodic_loop.h"
#include "server/detail/shared.h"
#include "server/test/server_rig.h"

namespace trocar::server {
namespace {

using link::ServerCommand;
using testing::wait_for;

/// A device that waits in write() while `is_blocked`, and counts writes and placements.
class BlockingDevice final : public devices::HapticDevice {
 public:
  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return "blocking"; }
  devices::DeviceReading read(double) noexcept override {
    devices::DeviceReading reading;
    reading.X_DS = testing::needle_at_depth(-10.0);
    return reading;
  }
  bool write(const Wrench& wrench_D) noexcept override {
    ++writes;
    while (is_blocked) std::this_thread::yield();
    force_n = wrench_D.force_n.norm();
    return true;
  }
  void hold(const devices::DeviceHand& hand) noexcept override { placements += hand.is_placed ? 1 : 0; }
  Status reconnect() override { return {}; }

  std::atomic<bool> is_blocked{false};
  std::atomic<int> writes{0}, placements{0};
  std::atomic<double> force_n{0.0};

 private:
  stylus::DevicePreset preset_ = testing::device_preset();
};

/// The real-time thread alone; the test is the link thread and the control thread.
class ServoThreadRig {
 public:
  ServoThreadRig()
      : builder_(testing::layered_opener(), testing::data_file("tissues.toml"), device.preset()),
        servo_(device, lenient(device.preset())) {
    auto made = builder_.load(testing::layered_request());
    TROCAR_CHECK(made.has_value());
    shared.scene.publish(std::make_shared<const ServoScene>(*made));
    thread_ = std::thread([this] { run_servo_thread(shared, servo_, 0); });
  }
  ~ServoThreadRig() {
    device.is_blocked = false;
    shared.is_stopping = true;
    thread_.join();
  }
  void hear() { shared.heard_ns = realtime::now_ns(); }
  bool start_forces() {
    return wait_for([&] {
      hear();
      shared.commands.push(ServerCommand::kStart, 0);
      return device.force_n > 0.0;
    });
  }
  bool wait_for_stops() {
    return wait_for([&] { return shared.commands.have_stops_taken_effect(); });
  }
  /// Periods with a write, counted from now.
  bool wait_for_writes(int count) {
    const int before = device.writes;
    return wait_for([&] {
      hear();
      return device.writes >= before + count;
    });
  }

  BlockingDevice device;
  Shared shared{1'000'000};

 private:
  /// A busy machine and a blocked device latch no fault: only commands turn the forces off.
  static ServoParams lenient(const stylus::DevicePreset& preset) {
    ServoParams params = servo_params(preset);
    params.max_hole_s = 1e6;
    params.gate.max_slow_s = 10.0;
    params.gate.stale_s = 1e6;
    return params;
  }

  SceneBuilder builder_;
  Servo servo_;
  std::thread thread_;
};

constexpr int kPeriods = 300;  ///< More than the fade (200 ms), and than a full queue takes (8 ms).

TEST(ServoThread, AppliesAStopWhenTheQueueIsFull) {
  ServoThreadRig rig;
  ASSERT_TRUE(rig.start_forces());
  rig.device.is_blocked = true;
  const int writes = rig.device.writes;
  ASSERT_TRUE(wait_for([&] { return rig.device.writes > writes; }));
  while (rig.shared.commands.push(ServerCommand::kStart, 0)) {
  }
  rig.shared.commands.stop(realtime::now_ns());
  EXPECT_FALSE(rig.shared.commands.have_stops_taken_effect()) << "the thread waits in the device";
  rig.device.is_blocked = false;
  ASSERT_TRUE(rig.wait_for_stops());
  EXPECT_FALSE(rig.shared.is_wanted);
  ASSERT_TRUE(rig.wait_for_writes(kPeriods));
  EXPECT_EQ(rig.device.force_n, 0.0);
  EXPECT_FALSE(rig.shared.is_wanted) << "a kStart from before the stop took effect";
}

TEST(ServoThread, AppliesAStopDuringALeaseAtOnce) {
  ServoThreadRig rig;
  ASSERT_TRUE(rig.start_forces());
  const std::uint64_t ticket = rig.shared.lease.ask();
  ASSERT_TRUE(wait_for([&] {
    rig.hear();
    return rig.shared.lease.is_leased(ticket);
  }));
  EXPECT_TRUE(rig.shared.is_wanted) << "forces come back after the lease";
  rig.shared.commands.push(ServerCommand::kStart, 0);
  rig.shared.commands.stop(realtime::now_ns());
  rig.shared.commands.push(ServerCommand::kResetFault, 0);
  ASSERT_TRUE(rig.wait_for_stops());
  EXPECT_TRUE(rig.shared.lease.is_leased(ticket)) << "before the device is given back";
  EXPECT_FALSE(rig.shared.is_wanted);
  rig.shared.lease.give_back(ticket);
  ASSERT_TRUE(rig.wait_for_writes(kPeriods));
  EXPECT_FALSE(rig.shared.is_wanted);
  EXPECT_EQ(rig.device.force_n, 0.0);
}

TEST(ServoThread, NewSceneAfterAStopKeepsForcesOff) {
  ServoThreadRig rig;
  ASSERT_TRUE(rig.start_forces());
  rig.shared.commands.stop(realtime::now_ns());
  ASSERT_TRUE(rig.wait_for_stops());
  SceneBuilder builder(testing::layered_opener(), testing::data_file("tissues.toml"), rig.device.preset());
  auto again = builder.load(testing::layered_request());
  ASSERT_TRUE(again);
  again->number += 1;
  rig.shared.scene.publish(std::make_shared<const ServoScene>(*again));
  rig.shared.commands.push(ServerCommand::kResetFault, 0);
  ASSERT_TRUE(rig.wait_for_writes(kPeriods));
  EXPECT_FALSE(rig.shared.is_wanted);
  EXPECT_EQ(rig.device.force_n, 0.0);
}

TEST(ServoThread, LaterHandTargetDoesNotDropAPlacement) {
  ServoThreadRig rig;
  rig.device.is_blocked = true;
  ASSERT_TRUE(wait_for([&] { return rig.device.writes > 0; }));
  CountedHand hand;
  hand.target.X_PN = Pose();
  hand.target.is_placed = true;
  hand.placements = 1;
  rig.shared.hand.write(hand);
  hand.target.is_placed = false;  // the next target, before the period
  rig.shared.hand.write(hand);
  rig.device.is_blocked = false;
  ASSERT_TRUE(wait_for([&] { return rig.device.placements > 0; }));
  rig.shared.hand.write(hand);
  ASSERT_TRUE(rig.wait_for_writes(10));
  EXPECT_EQ(rig.device.placements, 1);
}

}  // namespace
}  // namespace trocar::server
