#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/files/folders.h"
#include "tasks/action.h"
#include "tasks/testing/attempt_patient.h"

namespace trocar::tasks {
namespace {

SubstanceTable shipped() {
  auto table = load_substances(data_dir() / "substances.toml");
  EXPECT_TRUE(table) << (table ? "" : table.error().text());
  return table.value_or(SubstanceTable{});
}

TEST(Substances, PreferLabelsOverTissues) {
  const SubstanceTable table = shipped();
  EXPECT_EQ(table.of({1, "urinary_bladder", "fluid"}, false), Substance::kUrine);
  EXPECT_EQ(table.of({1, "kidney_cyst_left", "fluid"}, false), Substance::kFluid);
  EXPECT_EQ(table.of({1, "dural_sac", "csf"}, false), Substance::kCsf);
  EXPECT_EQ(table.of({1, "liver", "liver"}, false), Substance::kNothing);
  EXPECT_EQ(table.of({1, "liver", "liver"}, true), Substance::kBlood) << "a syringe draws it";
  EXPECT_EQ(table.of({1, "heart", "organ"}, false), Substance::kBlood);
  EXPECT_EQ(table.of({1, "fat", "adipose"}, true), Substance::kNothing);
}

TEST(Substances, NamesRoundTrip) {
  for (int n = 0; n <= static_cast<int>(kLastSubstance); ++n) {
    const auto substance = static_cast<Substance>(n);
    EXPECT_EQ(find_substance(to_string(substance)), substance);
    EXPECT_FALSE(shipped().looks.at(substance).flows.empty());
  }
  EXPECT_FALSE(find_substance("water"));
}

/// The vessel of the box patient lies from x = 20 to 25 in the liver.
Return at(double x_mm, const Vec3& axis_P, double bevel_deg, bool is_aspirated = false) {
  Needle needle = testing::make_gun();
  needle.outer_diameter_mm = 2.0;
  needle.bevel_deg = bevel_deg;
  return what_returns(shipped(), testing::make_box_patient(), needle, {x_mm, 60.0, 50.0}, axis_P, is_aspirated);
}

TEST(WhatReturns, IsTheSubstanceAtTheBevel) {
  EXPECT_EQ(at(22.0, Vec3::UnitX(), 45.0).substance, Substance::kBlood);
  EXPECT_NEAR(at(23.0, Vec3::UnitX(), 45.0).share, 1.0, 1e-9) << "the opening is 2 mm long";
  EXPECT_EQ(at(40.0, Vec3::UnitX(), 45.0).substance, Substance::kNothing);
  EXPECT_EQ(at(40.0, Vec3::UnitX(), 45.0, true).substance, Substance::kBlood) << "from the liver, by a syringe";
  EXPECT_EQ(at(500.0, Vec3::UnitX(), 45.0).substance, Substance::kNothing) << "outside of the CT";
}

TEST(WhatReturns, IsSlowForAPartlyCoveredBevel) {
  // The opening of 2 mm / tan 10° = 11.3 mm reaches back over the vessel's 5 mm.
  const Return part = at(23.0, Vec3::UnitX(), 10.0);
  EXPECT_EQ(part.substance, Substance::kBlood);
  EXPECT_TRUE(part.is_slow());
  EXPECT_NEAR(part.share, 3.0 / (2.0 / std::tan(10.0 * 3.14159265 / 180.0)), 0.12);
  // The tip is beyond the vessel, the rest of the opening still in it.
  EXPECT_EQ(at(28.0, Vec3::UnitX(), 10.0).substance, Substance::kBlood);
  EXPECT_EQ(at(40.0, Vec3::UnitX(), 10.0).substance, Substance::kNothing);
}

TEST(Substances, DamagedFilesAreRefused) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& text) {
    std::ofstream(folder / "s.toml") << text;
    const auto table = load_substances(folder / "s.toml");
    return table ? std::string("no error") : table.error().text();
  };
  EXPECT_NE(error_of("[tissues]\nvessel = \"wine\"\n[looks]\n").find("no substance \"wine\""), std::string::npos);
  EXPECT_NE(error_of("[tissues]\nvessel = \"blood\"\n[looks]\n").find("nothing"), std::string::npos);
  EXPECT_NE(error_of("[tisues]\n").find("did you mean"), std::string::npos);
}

}  // namespace
}  // namespace trocar::tasks
