#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "anatomy/testing/shipped_tissues.h"
#include "anatomy/tissue/tissue_fields.h"
#include "anatomy/tissue/tissue_table.h"
#include "config/toml_writer.h"

namespace trocar::anatomy {
namespace {

using testing::shipped_tissues;

/// Loads the shipped table with its [transfer] changed at one place.
Result<TissueTable> load_changed_transfer(const std::string& from, const std::string& to) {
  std::string text = shipped_tissues().to_toml();
  const std::size_t section = text.find("[transfer]");
  const std::size_t at = text.find(from, section);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return parse_tissue_table(text, "mine.toml");
}

TEST(HuTransferText, ShippedCurvesHaveOrderedKnotsAndThresholds) {
  const HuTransfer transfer = shipped_tissues().transfer;
  ASSERT_GE(transfer.knot_count, 8u);
  for (std::size_t n = 1; n < transfer.knot_count; ++n) EXPECT_GT(transfer.hu[n], transfer.hu[n - 1]);
  EXPECT_LT(transfer.gradient_none_hu_per_mm, transfer.gradient_full_hu_per_mm);
}

TEST(HuTransferText, GasHasNoForceAndCompactBoneStopsEveryDevice) {
  const HuTransfer transfer = shipped_tissues().transfer;
  for (const double hu : {-1000.0, -500.0, -250.0}) {
    EXPECT_EQ(transfer.at(hu).normal_n, 0.0) << hu;
    EXPECT_EQ(transfer.at(hu).tangential_n, 0.0) << hu;
    EXPECT_EQ(transfer.at(hu).resistance_n, 0.0) << hu;
    EXPECT_EQ(transfer.at(hu).viscosity_ns_per_mm, 0.0) << hu;
    EXPECT_EQ(transfer.at(hu).shaft_n_per_mm, 0.0) << hu;
  }
  constexpr double kStrongestDevice_n = 37.5;
  for (const double hu : {400.0, 700.0, 1500.0, 3071.0}) EXPECT_GT(transfer.at(hu).normal_n, kStrongestDevice_n) << hu;
}

TEST(HuTransferText, EnhancedVesselsDoNotFeelLikeBone) {
  const HuTransfer transfer = shipped_tissues().transfer;
  for (double hu = 120.0; hu <= 200.0; hu += 5.0) {
    EXPECT_LE(transfer.at(hu).normal_n, 1.5 * transfer.at(60.0).normal_n) << hu;
    EXPECT_LE(transfer.at(hu).resistance_n, 1.0) << hu;
  }
}

TEST(HuTransferText, ATableWithoutTheSectionLoads) {
  std::string text = shipped_tissues().to_toml();
  text.resize(text.find("[transfer]"));
  const auto table = parse_tissue_table(text, "old.toml");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(table->transfer.knot_count, 0u);
  EXPECT_EQ(table->to_toml().find("[transfer]"), std::string::npos);
}

TEST(HuTransferText, RefusesDamagedCurvesWithTheirLocation) {
  const HuTransfer transfer = shipped_tissues().transfer;
  const std::string second_knot = config::TomlValue(transfer.hu[1]).text();
  std::string too_many = "hu = [-1001";
  for (std::size_t n = 0; n < HuTransfer::kMaxKnots; ++n)
    too_many += fmt::format(", {}", -1000.5 + 0.01 * static_cast<double>(n));
  const struct {
    std::string from, to;
  } damages[] = {
      {", " + second_knot + ",", fmt::format(", {},", transfer.hu[0])},
      {", " + second_knot + ",", ", nan,"},
      {", " + second_knot + ",", ", -5000,"},
      {", " + second_knot + ",", ","},
      {"hu = [", too_many + ", "},
      {"hu = [", "hu = []\nnone = ["},
      {"normal_n = {values = [", "normal_n = {values = [0.0, "},
      {"normal_n = {values = [0.0", "normal_n = {values = [-1"},
      {"normal_n = {values = [0.0", "normal_n = {values = [201"},
      {"normal_n = {values = [0.0", "normal_n = {values = [nan"},
      {"normal_n = {values = [0.0", "normal_n = {values = [inf"},
      {"normal_n = {values = [0.0", "normal_n = {values = [\"0\""},
      {"normal_n =", "normal ="},
      {"source = \"", "note = \""},
      {"factors = [", "factors = [1.2, "},
      {", factors = [", ", factor = ["},
      {"gradient_scale_mm = {value = ", "gradient_scale_mm = {value = 1"},
      {"gradient_none_hu_per_mm = {value = ", "gradient_none_hu_per_mm = {value = 4"},
  };
  for (const auto& damage : damages) {
    const auto table = load_changed_transfer(damage.from, damage.to);
    ASSERT_FALSE(table) << damage.to;
    EXPECT_NE(table.error().text().find("mine.toml"), std::string::npos) << table.error().text();
    EXPECT_NE(table.error().text().find("transfer"), std::string::npos) << table.error().text();
  }
}

TEST(HuTransferText, AnAssumedCurveNeedsItsFactors) {
  const auto table = load_changed_transfer(", factors = [", ", faktors = [");
  ASSERT_FALSE(table);
  const std::string text = shipped_tissues().to_toml();
  const std::size_t begin = text.find(", factors = [", text.find("[transfer]"));
  const std::size_t end = text.find(']', begin) + 1;
  const auto without = load_changed_transfer(text.substr(begin, end - begin), "");
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().text().find("factors"), std::string::npos);
}

TEST(HuTransferText, OverridesReachTheGradientAndWalls) {
  TissueTable table = shipped_tissues();
  ASSERT_TRUE(apply_override(table, "transfer.gradient_scale_mm=2.5"));
  EXPECT_EQ(table.transfer.gradient_scale_mm, 2.5);
  EXPECT_EQ(table.provenance.at("transfer.gradient_scale_mm").source, "set by the user");
  ASSERT_TRUE(apply_override(table, "transfer.full=90"));
  ASSERT_TRUE(apply_override(table, "transfer.none=80"));
  ASSERT_TRUE(apply_override(table, "muscle.wall=1"));
  ASSERT_TRUE(apply_override(table, "dura.wall=0"));
  ASSERT_TRUE(apply_override(table, "liver.young=7"));
  EXPECT_TRUE(table.layers[*table.find_layer("muscle")].is_wall);
  EXPECT_FALSE(table.layers[*table.find_layer("dura")].is_wall);
  EXPECT_EQ(table.tissues[*table.find_tissue("liver")].young_kpa, 7.0);
  const auto again = parse_tissue_table(table.to_toml(), "stored");
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(again->to_toml(), table.to_toml());
}

TEST(HuTransferText, UnusableOverridesChangeNothing) {
  const TissueTable before = shipped_tissues();
  for (const char* bad : {"transfer.gradient_scale_mm=0", "transfer.scale=nan", "transfer.hu=1", "transfer.normal_n=3",
                          "transfer.none=999", "transfer.full=1", "muscle.wall=2", "muscle.wall=never",
                          "adipose.wall=1", "liver.young=-1", "liver.young=1000001"}) {
    TissueTable table = before;
    const Status status = apply_override(table, bad);
    ASSERT_FALSE(status) << bad;
    EXPECT_EQ(status.error().exit_status, 2) << bad;
    EXPECT_EQ(table.to_toml(), before.to_toml()) << bad;
  }
  TissueTable without = before;
  without.transfer = {};
  EXPECT_FALSE(apply_override(without, "transfer.scale=2"));
}

TEST(HuTransferText, YoungsModulusIsOptionalOnlyInOldStoredTables) {
  std::string text = shipped_tissues().to_toml();
  const auto drop_young = [&](std::string& t) {
    constexpr std::string_view kRow = "\nyoung_kpa";
    for (std::size_t at = t.find(kRow); at != std::string::npos && at < t.find("[transfer]"); at = t.find(kRow))
      t.erase(at, t.find('\n', at + 1) - at);
  };
  drop_young(text);
  const auto stored = parse_tissue_table(text, "stored");
  ASSERT_TRUE(stored) << stored.error().text();
  EXPECT_EQ(stored->tissues[*stored->find_tissue("liver")].young_kpa, TissueParams{}.young_kpa);
  EXPECT_TRUE(stored->provenance.at("tissues.liver.young_kpa").source.starts_with("assumed"));
  const std::size_t applied = text.find("applied_profile");
  text.replace(applied, text.find('\n') - applied, "[profiles.paper-a]");
  const auto file = parse_tissue_table(text, "mine.toml");
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().text().find("young_kpa"), std::string::npos) << file.error().text();
}

}  // namespace
}  // namespace trocar::anatomy
