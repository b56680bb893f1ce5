#include <gtest/gtest.h>

#include <fstream>

#include "core/files/folders.h"
#include "xray/geometry/c_arm.h"

namespace trocar::xray {
namespace {

TEST(CArmPresets, AreUsableAsShipped) {
  const auto presets = load_c_arms(data_dir() / "carms.toml");
  ASSERT_TRUE(presets) << presets.error().text();
  EXPECT_GE(presets->size(), 2U);
  for (const CArmPreset& preset : *presets) {
    EXPECT_TRUE(check_c_arm(preset.arm)) << preset.name;
    EXPECT_EQ(preset.arm.field_mm, preset.fields_mm.front()) << preset.name;
  }
}

TEST(CArmPresets, UnknownNameListsTheKnownOnes) {
  const auto preset = load_c_arm(data_dir() / "carms.toml", "ceiling");
  ASSERT_FALSE(preset);
  EXPECT_EQ(preset.error().exit_status, 2);
  EXPECT_NE(preset.error().advice.find("mobile"), std::string::npos);
  EXPECT_EQ(load_c_arm(data_dir() / "carms.toml", "mobile")->name, "mobile");
}

TEST(CArmPresets, RefuseADetectorBeforeTheIsocentre) {
  std::ifstream shipped(data_dir() / "carms.toml");
  std::string text((std::istreambuf_iterator<char>(shipped)), {});
  const std::string good = "source_detector_mm = {value = 1000,";
  ASSERT_NE(text.find(good), std::string::npos);
  text.replace(text.find(good), good.size(), "source_detector_mm = {value = 500,");
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "carms.toml") << text;
  const auto presets = load_c_arms(folder.path() / "carms.toml");
  ASSERT_FALSE(presets);
  EXPECT_NE(presets.error().where.find("carms.mobile"), std::string::npos);
}

}  // namespace
}  // namespace trocar::xray
