#include <gtest/gtest.h>

#include <fstream>

#include "core/files/folders.h"
#include "devices/device_spec.h"
#include "devices/simulated/virtual_haptic_device.h"
#include "devices/workspace_map.h"

namespace trocar::devices {
namespace {

constexpr const char* kDevice = "openhaptics:Left Device";

stylus::DevicePreset shipped_preset(const char* name) {
  return stylus::load_device_preset(data_dir() / "devices.toml", name).value();
}

/// A folder with the text as the profile of a device.
class Saved {
 public:
  explicit Saved(const std::string& text, const std::string& device = kDevice) {
    std::ofstream(stylus_profile_file(folder_.path(), device), std::ios::binary) << text;
  }
  const std::filesystem::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

std::string text_with(const std::string& weight, const std::string& more = "") {
  return "device = \"openhaptics:Left Device\"\npreset = \"omni\"\nstylus_weight_n = " + weight + "\n" + more;
}

TEST(StylusProfile, RoundTripsThroughItsFile) {
  const TemporaryFolder folder;
  const auto inner = folder / "styluses";
  for (const std::optional<double> lever_mm : {std::optional<double>(), std::optional<double>(-12.25)}) {
    ASSERT_TRUE(save_stylus_profile({kDevice, "omni", 0.8125, lever_mm}, inner));
    const auto loaded = load_stylus_profile(inner, kDevice);
    ASSERT_TRUE(loaded && *loaded);
    EXPECT_EQ((*loaded)->weight_n, 0.8125);
    EXPECT_EQ((*loaded)->lever_mm, lever_mm);
  }
  EXPECT_EQ(*load_stylus_profile(inner, "openhaptics"), std::nullopt) << "another device";
  EXPECT_TRUE(*remove_stylus_profile(inner, kDevice));
  EXPECT_FALSE(*remove_stylus_profile(inner, kDevice)) << "none is left";
  EXPECT_EQ(*load_stylus_profile(inner, kDevice), std::nullopt);
}

TEST(StylusProfile, UsesAUniqueFileForEachDevice) {
  const std::filesystem::path folder = "/folder";
  EXPECT_NE(stylus_profile_file(folder, "openhaptics:a b"), stylus_profile_file(folder, "openhaptics:a-b"));
  for (const char* device : {"haply:ws://localhost:10001#049D", "../../etc/passwd", "..", "."})
    EXPECT_EQ(stylus_profile_file(folder, device).parent_path(), folder) << device;
}

TEST(StylusProfile, OverridesTheWeightOfThePreset) {
  const TemporaryFolder folder;
  const stylus::DevicePreset premium = shipped_preset("premium");
  ASSERT_TRUE(save_stylus_profile({"a", "premium", 0.75, 31.0}, folder.path()));
  const auto with = with_stylus_profile(premium, folder.path(), "a");
  ASSERT_TRUE(with) << with.error().text();
  EXPECT_EQ(with->capability.stylus_weight_n, 0.75);
  EXPECT_EQ(with->capability.stylus_lever_mm, 31.0);
  EXPECT_EQ(with_stylus_profile(premium, {}, "a")->capability.stylus_weight_n, premium.capability.stylus_weight_n);
  EXPECT_EQ(with_stylus_profile(premium, folder.path(), "b")->capability.stylus_weight_n,
            premium.capability.stylus_weight_n);
  ASSERT_TRUE(save_stylus_profile({"a", "premium", 0.75, std::nullopt}, folder.path()));
  EXPECT_EQ(with_stylus_profile(premium, folder.path(), "a")->capability.stylus_lever_mm,
            premium.capability.stylus_lever_mm);
}

TEST(StylusProfile, RefusesAMalformedFileInOneLine) {
  const stylus::DevicePreset omni = shipped_preset("omni");
  ASSERT_TRUE(with_stylus_profile(omni, Saved(text_with("0.8")).path(), kDevice)) << "the usual text is valid";
  const std::string other = "device = \"x\"\npreset = \"omni\"\nstylus_weight_n = 0.5\n";
  const std::string premium = "device = \"openhaptics:Left Device\"\npreset = \"premium\"\nstylus_weight_n = 0.5\n";
  for (const std::string& text :
       {text_with("nan"), text_with("inf"), text_with("-0.1"), text_with("5.1"), text_with("1e300"),
        text_with("\"0.8\""), text_with(""), text_with("0.8", "stylus_lever_mm = nan\n"),
        text_with("0.8", "stylus_lever_mm = 201\n"), text_with("0.8", "stylus_wieght_n = 0.7\n"), text_with("0.9"),
        std::string(), std::string("\0\xff[[", 4), other, premium, std::string(100'000, '#')}) {
    const Saved saved(text);
    const auto with = with_stylus_profile(omni, saved.path(), kDevice);
    ASSERT_FALSE(with) << text;
    const std::string line = with.error().text();
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_NE(line.find(stylus_profile_file(saved.path(), kDevice).string()), std::string::npos) << line;
    EXPECT_NE(line.find("delete the file"), std::string::npos) << line;
  }
}

TEST(StylusProfile, ANumberOutOfRangeIsNotSaved) {
  const TemporaryFolder folder;
  for (const double weight_n : {std::nan(""), -0.01, 5.01})
    EXPECT_FALSE(save_stylus_profile({"a", "omni", weight_n, std::nullopt}, folder.path()));
  EXPECT_FALSE(save_stylus_profile({"a", "omni", 0.5, 1e9}, folder.path()));
  EXPECT_TRUE(folder.is_empty());
}

TEST(StylusProfile, IsUsedByADeviceThatIsOpened) {
  const TemporaryFolder folder;
  ASSERT_TRUE(save_stylus_profile({"virtual:premium", "premium", 0.8, 12.0}, folder.path()));
  DeviceOptions options;
  options.devices_file = data_dir() / "devices.toml";
  EXPECT_EQ((*open_device({"virtual", ""}, options))->preset().capability.stylus_weight_n, 0.5);
  options.stylus_folder = folder.path();
  const auto device = open_device({"virtual", ""}, options);
  ASSERT_TRUE(device) << device.error().text();
  EXPECT_EQ((*device)->preset().capability.stylus_weight_n, 0.8);
  EXPECT_EQ((*device)->preset().capability.stylus_lever_mm, 12.0);
  EXPECT_EQ((*open_device({"virtual", "omni"}, options))->preset().capability.stylus_weight_n, 0.5);
  std::ofstream(stylus_profile_file(folder.path(), "virtual:premium")) << "broken";
  EXPECT_FALSE(open_device({"virtual", "premium"}, options));
}

TEST(StylusProfile, KeepsTheWeightOfASimulatedStylus) {
  const TemporaryFolder folder;
  ASSERT_TRUE(save_stylus_profile({"virtual:premium", "premium", 0.9, std::nullopt}, folder.path()));
  DeviceOptions options;
  options.devices_file = data_dir() / "devices.toml";
  options.stylus_folder = folder.path();
  const auto device = open_device({"virtual", "premium"}, options).value();
  DeviceHand placed;
  placed.is_placed = true;
  double time_s = 1.0;
  device->read(time_s);
  device->hold(placed);
  const double lift_n = shipped_preset("premium").capability.stylus_weight_n;
  for (int i = 0; i < 1000; ++i) {
    device->read(time_s += 1e-3);
    device->write({lift_n * Vec3::UnitZ(), Vec3::Zero()});
  }
  constexpr double kFall_mm = 0.2;  // two periods without a force, 10 mm/s, which 0.04 N of friction stop
  EXPECT_NEAR(device->read(time_s += 1e-3).X_DS.p().z(), 0.0, kFall_mm);
}

}  // namespace
}  // namespace trocar::devices
