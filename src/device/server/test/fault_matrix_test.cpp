// Each fault of a faulty device on each simulated device: the force ends within the stated time, never exceeds a limit,
// and every period has its record.
#include <gtest/gtest.h>

#include <limits>

#include "core/text.h"
#include "devices/pointer/pointer_device.h"
#include "devices/simulated/faulty_device.h"
#include "devices/simulated/replay_device.h"
#include "devices/simulated/virtual_haptic_device.h"
#include "server/test/servo_rig.h"

namespace trocar::server {
namespace {

using testing::needle_at_depth;

constexpr double kFault_s = 4.0;  // when the device breaks: forces are on, the skin is pressed

constexpr double kPress_mm = 4.0;   // where the hand wants the tip; jitter must not pierce the skin there
constexpr double kTremor_mm = 0.8;  // slow, and more than the joints' friction holds

/// What must come of a fault.
struct Expected {
  const char* schedule;
  telemetry::GateFault fault;  ///< kNone: it goes on, within its limits.
  double within_s = 0;         ///< From the fault to zero force.
};
/// max_unread 20 ms, ramp 20 ms; stuck 5 s; a period for the fault to be read.
const std::vector<Expected>& all_faults() {
  static const std::vector<Expected> faults{
      {"nan@4", telemetry::GateFault::kNotFinite, 0.025},
      {"disconnect@4", telemetry::GateFault::kDeviceLost, 0.025},
      {"disconnect@4+0.05", telemetry::GateFault::kDeviceLost, 0.025},
      {"dropped@4", telemetry::GateFault::kDeviceSilent, 0.045},
      {"stuck@4", telemetry::GateFault::kEncoderStuck, 5.1},
      {"slow_read:400@4", telemetry::GateFault::kLoopStalled, 0.9},
      {"slow_write:400@4", telemetry::GateFault::kLoopStalled, 1.3},
      {"slow_read:3@4", telemetry::GateFault::kNone},  // every millisecond up to 1 s: slow_loop_test.cpp
      {"slow_write:3@4", telemetry::GateFault::kNone},
      {"jitter:0.05@4+2", telemetry::GateFault::kNone},
      {"jitter:0.3@4+2", telemetry::GateFault::kVibration, 0.3},  // 420 mm/s rms
      {"jump:50@4+0.5", telemetry::GateFault::kImpossibleMotion, 0.025},
      {"dropped@4+0.01", telemetry::GateFault::kNone},
  };
  return faults;
}

void count_wait(void* waited_s, double wait_ms) noexcept {
  *static_cast<double*>(waited_s) += 1e-3 * wait_ms;
}

struct Kind {
  const char* name;
  const char* preset;
};

std::unique_ptr<devices::HapticDevice> make_device(const Kind& kind, const stylus::DevicePreset& preset) {
  const std::string name = kind.name;
  if (name == "virtual")
    return std::make_unique<devices::VirtualHapticDevice>(preset, devices::SimulatedDeviceParams{});
  if (name == "mouse") return std::make_unique<devices::PointerDevice>(preset, devices::PointerParams{});
  // A recorded hand: down onto the skin within 3 s, then trembling there.
  std::vector<Pose> poses;
  for (int i = 0; i < 20'000; ++i) {
    const double depth_mm = std::min(2.5, -10.0 + 0.005 * i) + kTremor_mm * std::sin(0.012 * i);
    poses.push_back(needle_at_depth(depth_mm));
  }
  return std::make_unique<devices::ReplayDevice>(preset, "recorded", std::move(poses), 1000.0);
}

/// The hand of a client, in P: as the recorded one.
link::HandTarget hand_at(double time_s) {
  link::HandTarget hand;
  const double depth_mm = std::min(kPress_mm, -10.0 + 5.0 * time_s) + kTremor_mm * std::sin(12.0 * time_s);
  hand.X_PN = needle_pose({0.0, 0.0, depth_mm}, Vec3::UnitZ());
  hand.server_time_s = time_s;
  hand.is_placed = time_s <= 0.001;
  return hand;
}

class FaultMatrix : public ::testing::TestWithParam<std::tuple<Kind, std::size_t>> {};

TEST_P(FaultMatrix, EndsAtZeroInTimeAndStaysWithinItsLimits) {
  const auto& [kind, number] = GetParam();
  const Expected& expected = all_faults()[number];
  const stylus::DevicePreset preset = testing::device_preset(kind.preset);
  double waited_s = 0.0;
  devices::FaultyDevice device(make_device(kind, preset), {*devices::parse_fault(expected.schedule)}, 7,
                               {count_wait, &waited_s});
  SceneBuilder builder(testing::layered_opener(), testing::data_file("tissues.toml"), preset);
  const link::LoadScene request = testing::layered_request();
  const auto scene = builder.load(request);
  ASSERT_TRUE(scene) << scene.error().text();
  Servo servo(device, servo_params(preset));

  double time_s = 0.0, zero_since_s = std::numeric_limits<double>::infinity(), before_n = 0.0;
  std::uint64_t ticks = 0;
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  while (time_s < kFault_s + 7.0) {
    ServoInput input;
    const double waited_now_s = std::exchange(waited_s, 0.0);
    input.dt_s = 0.001 + waited_now_s;
    input.busy_s = waited_now_s;
    time_s += input.dt_s;
    input.now_s = time_s;
    input.scene = &*scene;
    input.is_wanted = true;
    input.hand = hand_at(time_s);
    const ServoRecord record = servo.step(input);
    const double written_n = record.written_D.force_n.norm();
    ASSERT_EQ(record.tick, ticks++);
    ASSERT_LE(written_n, preset.capability.peak_force_n + 1e-9);
    ASSERT_LE(record.written_D.torque_nmm.norm(), preset.capability.peak_torque_nmm + 1e-9);
    if (time_s < kFault_s) before_n = written_n;
    zero_since_s = written_n > 0.0 ? std::numeric_limits<double>::infinity() : std::min(zero_since_s, time_s);
    fault = record.sample.gate_fault;
  }
  EXPECT_TRUE(!preset.has_force() || before_n > 0.1) << "there was something to be felt before";
  // A mouse has no hand whose force could go wrong: nothing is watched there.
  const bool is_of_force =
      expected.fault == telemetry::GateFault::kEncoderStuck || expected.fault == telemetry::GateFault::kVibration;
  if (!preset.has_force() && is_of_force) return;
  EXPECT_STREQ(to_string(fault), to_string(expected.fault));
  if (expected.fault == telemetry::GateFault::kNone) return;
  EXPECT_LE(zero_since_s, kFault_s + expected.within_s);
}

INSTANTIATE_TEST_SUITE_P(Devices, FaultMatrix,
                         ::testing::Combine(::testing::Values(Kind{"virtual", "premium"}, Kind{"virtual", "omni"},
                                                              Kind{"virtual", "omega7"}, Kind{"virtual", "inverse3"},
                                                              Kind{"mouse", "mouse"}, Kind{"replay", "premium"}),
                                            ::testing::Range<std::size_t>(0, all_faults().size())),
                         [](const auto& param) {
                           std::string name = std::string(std::get<0>(param.param).name) + "_" +
                                              std::get<0>(param.param).preset + "_" +
                                              all_faults()[std::get<1>(param.param)].schedule;
                           for (char& c : name) {
                             if (!ascii::is_letter_or_digit(c)) c = '_';
                           }
                           return name;
                         });

}  // namespace
}  // namespace trocar::server
