#include "tasks/needle.h"

#include <gtest/gtest.h>

#include <map>

#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/testing/changed_file.h"

namespace trocar::tasks {
namespace {

const std::filesystem::path kFile = data_dir() / "needles.toml";

TEST(Needle, DiametersFollowTheGauge) {
  const auto needles = load_needles(kFile);
  ASSERT_TRUE(needles) << needles.error().text();
  // Needle gauge comparison chart (Birmingham wire gauge), mm.
  const std::map<double, double> chart = {{14, 2.108}, {15, 1.829}, {16, 1.651},
                                          {17, 1.473}, {18, 1.270}, {22, 0.7176}};
  const std::map<double, double> bore = {{14, 1.600}, {15, 1.372}, {16, 1.194}, {17, 1.067}, {18, 0.838}, {22, 0.413}};
  EXPECT_GE(needles->size(), 7u);
  for (const Needle& needle : *needles) {
    ASSERT_TRUE(chart.contains(needle.gauge)) << needle.name;
    EXPECT_NEAR(needle.outer_diameter_mm, chart.at(needle.gauge), 0.0006) << needle.name;
    if (needle.is_coaxial) {  // of thin wall: its gun passes through it
      EXPECT_GT(needle.inner_diameter_mm, needle.stylet_diameter_mm) << needle.name;
      continue;
    }
    EXPECT_NEAR(needle.inner_diameter_mm, bore.at(needle.gauge), 0.0006) << needle.name;
    EXPECT_LE(needle.stylet_diameter_mm, needle.inner_diameter_mm) << needle.name;
    EXPECT_FALSE(needle.title.empty());
    EXPECT_EQ(needle.is_biopsy, needle.name.starts_with("biopsy")) << needle.name;
  }
}

TEST(Needle, NotchAndDeadSpaceFitIntoTheThrow) {
  const auto needle = load_needle(kFile, "biopsy-18g");
  ASSERT_TRUE(needle);
  EXPECT_EQ(needle->throw_mm, 22.0);
  EXPECT_LE(needle->notch_mm + needle->dead_space_mm, needle->throw_mm);
  EXPECT_EQ(needle->notch_middle_mm(), needle->throw_mm - needle->dead_space_mm - needle->notch_mm / 2);
  EXPECT_EQ(load_needle(kFile, "chiba-22g")->notch_middle_mm(), 0.0);
}

TEST(Needle, OnlyNeedlesOfTheSameUseReplaceIt) {
  const auto needles = load_needles(kFile);
  ASSERT_TRUE(needles);
  std::vector<std::string> names;
  for (const Needle& needle : needles_like(*needles, "biopsy-18g")) names.push_back(needle.name);
  EXPECT_EQ(names, (std::vector<std::string>{"biopsy-18g", "biopsy-18g-coaxial", "biopsy-16g"}));
  EXPECT_TRUE(needles_like(*needles, "unheard-of").empty());
  for (const Needle& needle : *needles) EXPECT_EQ(needle.is_biopsy, needle.use == "biopsy") << needle.name;
}

TEST(Needle, ParacentesisNeedleUsesTheTrocarModel) {
  EXPECT_EQ(load_needle(kFile, "paracentesis-14g")->model, "trocar");
  EXPECT_EQ(load_needle(kFile, "chiba-22g")->model, "chiba");
}

TEST(Needle, UnknownNameListsTheKnownOnes) {
  const auto needle = load_needle(kFile, "chiba-23g");
  ASSERT_FALSE(needle);
  EXPECT_EQ(needle.error().exit_status, 2);
  EXPECT_NE(needle.error().advice.find("chiba-22g"), std::string::npos);
}

TEST(Needle, ImpossibleNeedleIsRefused) {
  const auto is_refused = [](const std::string& from, const std::string& to) {
    return !testing::load_changed(kFile, from, to, [](const auto& file) { return load_needles(file); });
  };
  EXPECT_FALSE(is_refused("gauge", "gauge"));
  EXPECT_TRUE(is_refused("dead_space_mm = {value = 3", "dead_space_mm = {value = 4"));
  EXPECT_TRUE(is_refused("throw_mm = ", "trow_mm = "));
  EXPECT_TRUE(is_refused("value = 1.27", "value = 127"));
  EXPECT_TRUE(is_refused("inner_diameter_mm = {value = 0.838", "inner_diameter_mm = {value = 1.26"));
  EXPECT_TRUE(
      is_refused("stylet_diameter_mm = {value = 0.788, source = \"assumed, 0.05 mm of play\", range = [0.688, 0.838]",
                 "stylet_diameter_mm = {value = 0.85, source = \"mine\""));
  EXPECT_TRUE(is_refused("bevel_share = {value = 0.1", "bevel_share = {value = 1.1"));
  EXPECT_TRUE(is_refused("is_biopsy = true", "is_biopsy = 1"));
  EXPECT_TRUE(is_refused("model = \"trocar\"", "model = \"trokar\""));
  EXPECT_TRUE(is_refused("use = \"spinal\"", "use = \"spine\""));
}

}  // namespace
}  // namespace trocar::tasks
