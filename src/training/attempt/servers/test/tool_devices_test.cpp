#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>

#include "attempt/servers/haptic_servers.h"
#include "core/files/folders.h"

namespace trocar::attempt {
namespace {

std::vector<std::string> specs() {
  std::vector<std::string> all;
  for (const ToolDevice& device : tool_devices()) all.push_back(device.spec);
  return all;
}

bool has(const std::vector<std::string>& all, const char* spec) {
  return std::find(all.begin(), all.end(), spec) != all.end();
}

/// The vendor's folder of configurations, made by the test.
struct ToolDevices : ::testing::Test {
  ToolDevices() {
    std::filesystem::create_directories(folder / "config");
    setenv("GTDD_HOME", (folder / ".").c_str(), 1);
  }
  ~ToolDevices() override { unsetenv("GTDD_HOME"); }
  void configure(const char* name) const { std::ofstream(folder / "config" / name) << "{}\n"; }

  TemporaryFolder folder;
};

TEST_F(ToolDevices, AreListedByVendorSetupNames) {
  configure("Right Device.config");
  configure("Left Device.config");
  configure("notes.txt");
  const std::vector<std::string> all = specs();
  EXPECT_EQ(all.front(), "mouse");
  EXPECT_TRUE(has(all, "openhaptics:Left Device"));
  EXPECT_TRUE(has(all, "openhaptics:Right Device"));
  EXPECT_FALSE(has(all, "openhaptics"));
  EXPECT_EQ(std::count_if(all.begin(), all.end(), [](const std::string& s) { return s.starts_with("openhaptics"); }),
            2);
  EXPECT_EQ(device_title("openhaptics:Left Device"), "Left Device (OpenHaptics)");
}

TEST_F(ToolDevices, IncludeTheDefaultDeviceWithoutASetup) {
  EXPECT_TRUE(has(specs(), "openhaptics"));
}

TEST_F(ToolDevices, RefuseOneDeviceForTwoTools) {
  EXPECT_TRUE(can_be_used_together("mouse", "mouse"));
  EXPECT_TRUE(can_be_used_together("gamepad", "mouse"));
  EXPECT_TRUE(can_be_used_together("openhaptics:Left Device", "openhaptics:Right Device"));
  EXPECT_FALSE(can_be_used_together("gamepad", "gamepad"));
  EXPECT_FALSE(can_be_used_together("openhaptics:Left Device", "openhaptics:Left Device"));
  EXPECT_FALSE(can_be_used_together("openhaptics", "openhaptics:Default Device"));
}

}  // namespace
}  // namespace trocar::attempt
