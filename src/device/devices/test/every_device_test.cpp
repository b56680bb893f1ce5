// What holds for every device that needs no hardware and no other program.
#include <gtest/gtest.h>

#include <limits>

#include "core/files/folders.h"
#include "core/testing/allocation_guard.h"
#include "devices/device_spec.h"

namespace trocar::devices {
namespace {

class EveryDevice : public ::testing::TestWithParam<const char*> {
 protected:
  static DeviceOptions options() {
    DeviceOptions options;
    options.devices_file = data_dir() / "devices.toml";
    options.motion.poses = {Pose(), Pose::translation({1.0, 0.0, 0.0}), Pose::translation({2.0, 0.0, 0.0})};
    return options;
  }
  static std::unique_ptr<HapticDevice> open(const DeviceOptions& options) {
    const auto spec = parse_device_spec(GetParam());
    EXPECT_TRUE(spec) << spec.error().text();
    auto device = open_device(*spec, options);
    EXPECT_TRUE(device) << device.error().text();
    return *std::move(device);
  }
};

DeviceHand moving_hand() {
  DeviceHand hand;
  hand.X_DS = Pose::translation({1.0, 2.0, 3.0});
  hand.v_D = Vec3(10.0, 0.0, 0.0);
  hand.w_D = Vec3(0.0, 1.0, 0.0);
  hand.stiffness_n_per_mm = 0.6;
  hand.damping_ns_per_mm = 0.012;
  hand.mass_kg = 0.15;
  hand.turning_nmm_per_rad = 300.0;
  hand.point_mm = 160.0;
  hand.is_held = true;
  return hand;
}

TEST_P(EveryDevice, NeverAllocatesInThePeriod) {
  const auto device = open(options());
  const DeviceHand hand = moving_hand();
  const testing::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    device->read(0.001 * i);
    device->hold(hand);
    device->write({Vec3::Ones(), Vec3::Ones()});
  }
  device->read(10.0);
  device->hold({});
  EXPECT_EQ(guard.count(), 0u);
}

TEST_P(EveryDevice, RefusesWrenchesBeyondTheGateLimits) {
  const auto device = open(options());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  double time_s = 0.0;
  device->read(time_s);
  device->hold(moving_hand());
  for (const double bad : {nan, infinite, -infinite, 1e200, 1e6}) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_FALSE(device->write({Vec3::Unit(axis) * bad, Vec3::Zero()})) << bad;
      EXPECT_FALSE(device->write({Vec3::Zero(), Vec3::Unit(axis) * bad})) << bad;
      for (int i = 0; i < 5; ++i) EXPECT_TRUE(device->read(time_s += 0.001).X_DS.is_finite()) << bad;
    }
  }
  EXPECT_TRUE(device->write({Vec3::Ones(), Vec3::Ones()}));
}

TEST_P(EveryDevice, RefusedWrenchMovesNothing) {
  const auto device = open(options());
  const auto twin = open(options());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(device->read(0.001 * i).X_DS.p(), twin->read(0.001 * i).X_DS.p()) << i;
    device->hold(moving_hand());
    twin->hold(moving_hand());
    device->write({{1.0, 0.0, 0.0}, Vec3::Zero()});
    twin->write({{1.0, 0.0, 0.0}, Vec3::Zero()});
    device->write({{nan, 0.0, 0.0}, Vec3::Zero()});
  }
}

TEST_P(EveryDevice, UsesTheRequestedPreset) {
  DeviceOptions wanted = options();
  wanted.preset = "desktop";
  const std::string spec = GetParam();
  if (spec.find("virtual:") != 0) {
    EXPECT_EQ(open(wanted)->preset().name, "desktop");
  } else {
    EXPECT_NE(open(wanted)->preset().name, "desktop");  // named in the spec
  }
  wanted.preset = "no such device";
  if (spec.find("virtual:") == 0) return;
  const auto device = open_device(*parse_device_spec(spec), wanted);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().exit_status, 2);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryDevice,
                         ::testing::Values("virtual", "virtual:omni", "virtual:inverse3", "virtual:falcon", "mouse",
                                           "replay:x"));

TEST(VirtualDeviceSpec, DefaultsToThePremium) {
  DeviceOptions options;
  options.devices_file = data_dir() / "devices.toml";
  EXPECT_EQ((*open_device({"virtual", ""}, options))->name(), "virtual:premium");
  EXPECT_EQ((*open_device({"virtual", "omega7"}, options))->name(), "virtual:omega7");
  EXPECT_EQ((*open_device({"mouse", ""}, options))->name(), "mouse");
}

}  // namespace
}  // namespace trocar::devices
