#include "devices/device_spec.h"

#include <gtest/gtest.h>

#include "core/testing/allocation_guard.inc.h"

namespace trocar::devices {
namespace {

TEST(DeviceSpec, SplitsAtTheFirstColon) {
  const auto haply = parse_device_spec("haply:ws://localhost:10001");
  ASSERT_TRUE(haply) << haply.error().text();
  EXPECT_EQ(haply->kind, "haply");
  EXPECT_EQ(haply->argument, "ws://localhost:10001");
  const auto mouse = parse_device_spec("mouse");
  ASSERT_TRUE(mouse);
  EXPECT_EQ(mouse->kind, "mouse");
  EXPECT_TRUE(mouse->argument.empty());
}

TEST(DeviceSpec, UnknownKindListsTheKnownOnes) {
  for (const char* text : {"", ":", "phantom", "Virtual", "virtual ", "mouse2:x"}) {
    const auto spec = parse_device_spec(text);
    ASSERT_FALSE(spec) << text;
    EXPECT_EQ(spec.error().exit_status, 2) << text;
    for (const char* kind : {"virtual", "mouse", "gamepad", "spacemouse", "replay", "openhaptics", "haply"}) {
      EXPECT_NE(spec.error().text().find(kind), std::string::npos) << text << " " << kind;
    }
  }
}

TEST(DeviceSpec, MissingOrNeedlessArgumentIsRefused) {
  for (const char* text : {"replay", "replay:", "virtual:", "mouse:left", "mouse:"}) {
    const auto spec = parse_device_spec(text);
    ASSERT_FALSE(spec) << text;
    EXPECT_EQ(spec.error().exit_status, 2) << text;
  }
}

TEST(DeviceSpec, OpeningAnUnknownKindIsAnError) {
  const auto device = open_device({"phantom", ""}, {});
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().exit_status, 2);
}

}  // namespace
}  // namespace trocar::devices
