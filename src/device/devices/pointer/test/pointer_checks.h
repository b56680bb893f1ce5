#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/files/folders.h"
#include "core/testing/allocation_guard.h"
#include "devices/device_spec.h"
#include "devices/test/bounded_wait.h"

/// Functions shared by the tests of all polled pointers.
namespace trocar::testing {

inline constexpr double kTick_s = 0.001;

/// Reads with a simulated clock until the condition holds. The thread of the device runs asynchronously.
template <class Predicate>
bool reads_until(devices::HapticDevice& device, double& now_s, Predicate&& holds) {
  return wait_until([&] {
    now_s += kTick_s;
    return holds(device.read(now_s));
  });
}

inline bool is_gone(const devices::DeviceReading& reading) {
  return reading.status == devices::DeviceStatus::kDisconnected;
}

inline void expect_no_allocation(devices::HapticDevice& device) {
  constexpr int kTicks = 1000;
  const AllocationGuard guard;
  for (int i = 0; i < kTicks; ++i) {
    device.read(kTick_s * i);
    device.write({Vec3(0.0, 1.0, 0.0), Vec3::Zero()});
  }
  EXPECT_EQ(guard.count(), 0U);
}

inline void expect_opened_by_name(const std::string& name) {
  const auto spec = devices::parse_device_spec(name);
  ASSERT_TRUE(spec.has_value()) << spec.error().text();
  devices::DeviceOptions options;
  options.devices_file = data_dir() / "devices.toml";
  const auto device = devices::open_device(*spec, options);
  ASSERT_TRUE(device.has_value()) << device.error().text();
  EXPECT_EQ((*device)->preset().name, name);
}

}  // namespace trocar::testing
