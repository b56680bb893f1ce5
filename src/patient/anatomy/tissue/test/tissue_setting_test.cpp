#include <gtest/gtest.h>

#include <limits>

#include "anatomy/tissue/tissue_settings.h"
#include "core/files/folders.h"

namespace trocar::anatomy {
namespace {

TEST(TissueSetting, RoundTripsThroughText) {
  const double never = std::numeric_limits<double>::infinity();
  for (const TissueSetting& setting : {TissueSetting{"liver", "k", 0.1 + 0.2}, TissueSetting{"layers.skin", "nu", 1e-9},
                                       TissueSetting{"muscle", "fp", never}}) {
    const auto again = parse_setting(to_string(setting));
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(*again, setting);
    EXPECT_EQ(make_setting(name_of(setting), setting.value), setting);
  }
  EXPECT_EQ(to_string(TissueSetting{"muscle", "fp", never}), "muscle.fp=never");
}

TEST(TissueSetting, RefusesMalformedText) {
  for (const char* bad : {"", "liver", "liver=1", "liver.k", "liver.k=", "liver.k=x", "liver.k=0.5x", "liver.k=nan"}) {
    const auto setting = parse_setting(bad);
    ASSERT_FALSE(setting) << bad;
    EXPECT_EQ(setting.error().exit_status, 2) << bad;
  }
}

TEST(TissueSetting, ChangesATableLikeItsText) {
  const auto shipped = load_tissue_table(data_dir() / "tissues.toml");
  ASSERT_TRUE(shipped) << shipped.error().text();
  for (const char* text : {"liver.k=0.5", "layers.vessel.nu=0.03", "tissues.vessel.nu=0.01", "transfer.tn_factor=2",
                           "skin.thickness_mm=3", "muscle.fp=never", "dura.wall=0"}) {
    TissueTable by_text = *shipped, by_setting = *shipped;
    ASSERT_TRUE(apply_override(by_text, text)) << text;
    ASSERT_TRUE(apply_setting(by_setting, *parse_setting(text))) << text;
    EXPECT_EQ(by_setting.to_toml(), by_text.to_toml()) << text;
  }
}

TEST(TissueSetting, RefusesUnrepresentableValues) {
  auto table = load_tissue_table(data_dir() / "tissues.toml");
  ASSERT_TRUE(table);
  const std::string before = table->to_toml();
  EXPECT_FALSE(apply_setting(*table, {"liver", "k", std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_FALSE(apply_setting(*table, {"liver", "k", std::numeric_limits<double>::infinity()}));
  EXPECT_FALSE(apply_setting(*table, {"", "k", 1.0}));
  EXPECT_EQ(table->to_toml(), before);
}

}  // namespace
}  // namespace trocar::anatomy
