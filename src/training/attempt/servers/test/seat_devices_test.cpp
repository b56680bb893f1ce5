#include "attempt/servers/seat_devices.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>

#include "core/files/temporary_folder.h"

namespace trocar::attempt {
namespace {

std::vector<std::string> specs() {
  std::vector<std::string> all;
  for (const SeatDevice& device : seat_devices()) all.push_back(device.spec);
  return all;
}

bool has(const std::vector<std::string>& all, const char* spec) {
  return std::find(all.begin(), all.end(), spec) != all.end();
}

/// The vendor's folder of configurations, made by the test.
struct SeatDevices : ::testing::Test {
  SeatDevices() {
    std::filesystem::create_directories(folder / "config");
    setenv("GTDD_HOME", (folder / ".").c_str(), 1);
  }
  ~SeatDevices() override { unsetenv("GTDD_HOME"); }
  void configure(const char* name) const { std::ofstream(folder / "config" / name) << "{}\n"; }

  TemporaryFolder folder;
};

TEST_F(SeatDevices, AreListedByTheNamesOfTheVendorsSetup) {
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
  EXPECT_EQ(seat_device_title("openhaptics:Left Device"), "Left Device (OpenHaptics)");
}

TEST_F(SeatDevices, WithoutASetupThereIsTheDefaultDevice) {
  EXPECT_TRUE(has(specs(), "openhaptics"));
}

TEST_F(SeatDevices, OneDeviceIsNotInTwoHands) {
  EXPECT_TRUE(can_share_seat("mouse", "mouse"));
  EXPECT_TRUE(can_share_seat("gamepad", "mouse"));
  EXPECT_TRUE(can_share_seat("openhaptics:Left Device", "openhaptics:Right Device"));
  EXPECT_FALSE(can_share_seat("gamepad", "gamepad"));
  EXPECT_FALSE(can_share_seat("openhaptics:Left Device", "openhaptics:Left Device"));
  EXPECT_FALSE(can_share_seat("openhaptics", "openhaptics:Default Device"));
}

}  // namespace
}  // namespace trocar::attempt
