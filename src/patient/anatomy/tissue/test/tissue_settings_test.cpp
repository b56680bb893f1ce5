#include "anatomy/tissue/tissue_settings.h"

#include <gtest/gtest.h>

#include "anatomy/testing/shipped_tissues.h"

namespace trocar::anatomy {
namespace {

using testing::shipped_tissues;

using Settings = std::vector<std::string>;

TissueTable with(TissueTable table, const Settings& settings) {
  for (const std::string& setting : settings) {
    const Status status = apply_override(table, setting);
    EXPECT_TRUE(status) << status.error().text();
  }
  return table;
}

TEST(TissueSettings, ListTheDifferencesOfTwoTables) {
  const TissueTable table = shipped_tissues();
  EXPECT_TRUE(changed_settings(table, table).empty());
  const Settings settings{"skin.fp=6",   "tissues.liver.nu=0.011", "bone.fp=50",
                          "skin.wall=1", "skin.thickness_mm=3.5",  "transfer.tn_factor=1.3"};
  const TissueTable other = with(table, settings);
  const Settings changed = changed_settings(table, other);
  EXPECT_EQ(changed.front(), "skin.fp=6");
  EXPECT_EQ(with(table, changed).to_toml(), other.to_toml());
  // And back: "never" is a number, too.
  EXPECT_EQ(changed_settings(with(other, {"bone.fp=never"}), other), Settings{"bone.fp=50"});
  EXPECT_EQ(changed_settings(other, with(other, {"bone.fp=never"})), Settings{"bone.fp=never"});
}

TEST(TissueSettings, OfTheUserListOnlyExplicitSettings) {
  const TissueTable table = shipped_tissues();
  EXPECT_TRUE(user_settings(table).empty());
  EXPECT_EQ(user_settings(with(table, {"skin.fp=6"})), Settings{"skin.fp=6"});
  const auto stored = parse_tissue_table(with(table, {"skin.fp=6"}).to_toml(), "stored");
  ASSERT_TRUE(stored) << stored.error().text();
  EXPECT_EQ(user_settings(*stored), Settings{"skin.fp=6"});
}

TEST(TissueSettings, ReportAReplacedTable) {
  TissueTable other = shipped_tissues();
  other.layers.front().name = "hide";
  EXPECT_EQ(changed_settings(shipped_tissues(), other), Settings{"tissues=replaced"});
  other = shipped_tissues();
  other.transfer.laws[0].normal_n += 1.0;
  other.transfer.laws[1].normal_n += 1.0;
  EXPECT_EQ(changed_settings(shipped_tissues(), other), Settings{"transfer.tn=replaced"});
}

TEST(TissueSettings, SurviveNamesWithControlCharacters) {
  TissueTable table = shipped_tissues();
  table.profile =
      "a\x7f"
      "b\tc";
  const auto stored = parse_tissue_table(table.to_toml(), "stored");
  ASSERT_TRUE(stored) << stored.error().text();
  EXPECT_EQ(stored->profile, table.profile);
}

}  // namespace
}  // namespace trocar::anatomy
