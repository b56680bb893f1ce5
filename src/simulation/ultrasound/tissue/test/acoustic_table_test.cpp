#include "ultrasound/tissue/acoustic_table.h"

#include <gtest/gtest.h>

#include <set>

#include "anatomy/tissue/tissue_table.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/testing/changed_file.h"

namespace trocar::ultrasound {
namespace {

const std::filesystem::path kAcousticsFile = data_dir() / "acoustics.toml";

AcousticTable shipped_acoustics() {
  auto table = load_acoustic_table(kAcousticsFile);
  EXPECT_TRUE(table) << table.error().text();
  return table.value_or(AcousticTable{});
}

const AcousticTissue& tissue(const AcousticTable& table, std::string_view name) {
  const auto index = table.find(name);
  EXPECT_TRUE(index) << name;
  return table.tissues[index.value_or(0)];
}

TEST(AcousticTable, CoversTheHapticTissuesAndItsOwn) {
  const auto felt = anatomy::load_tissue_table(data_dir() / "tissues.toml");
  ASSERT_TRUE(felt) << felt.error().text();
  std::set<std::string> expected = {"air", "water", "gel", "kidney_pyramid", "renal_sinus"};
  for (const auto& params : felt->tissues) expected.insert(params.name);
  std::set<std::string> heard;
  for (const AcousticTissue& t : shipped_acoustics().tissues) heard.insert(t.name);
  EXPECT_EQ(heard, expected);
}

TEST(AcousticTable, AirIsFirstAndUnknownNamesAreNotFound) {
  const AcousticTable table = shipped_acoustics();
  EXPECT_EQ(table.find("air"), 0);
  EXPECT_FALSE(table.find("unobtainium"));
}

TEST(AcousticTable, EchoLevelsMatchRadiologicalOrder) {
  const AcousticTable table = shipped_acoustics();
  double last_db = 100.0;
  for (const char* name : {"organ", "spleen", "liver", "kidney", "vessel", "gallbladder"}) {
    EXPECT_LT(tissue(table, name).backscatter_db, last_db) << name;
    last_db = tissue(table, name).backscatter_db;
  }
  EXPECT_EQ(tissue(table, "liver").backscatter_db, 0.0);
}

TEST(AcousticTable, BorderReflectionsMatchTextbookValues) {
  const AcousticTable table = shipped_acoustics();
  const auto echo = [&](const char* from, const char* to) {
    return reflection(tissue(table, from).impedance_mrayl(), tissue(table, to).impedance_mrayl());
  };
  EXPECT_LT(echo("muscle", "gas"), -0.999);
  EXPECT_GT(echo("muscle", "bone"), 0.5);
  EXPECT_NEAR(echo("adipose", "muscle"), 0.1, 0.05);
  EXPECT_LT(std::abs(echo("liver", "kidney")), 0.03);
  // The diaphragm: liver to lung is the strong mirror.
  EXPECT_LT(echo("liver", "lung"), -0.5);
}

TEST(AcousticTable, ReflectedAndTransmittedEnergyAddUp) {
  for (const auto& [z1, z2] : {std::pair{1.6, 1.4}, std::pair{1.4, 7.0}, std::pair{1.6, 0.0004}}) {
    const double r = reflection(z1, z2);
    const double transmitted = 4.0 * z1 * z2 / ((z1 + z2) * (z1 + z2));
    EXPECT_NEAR(r * r + transmitted, 1.0, 1e-12);
    EXPECT_EQ(reflection(z2, z1), -r);
  }
  EXPECT_EQ(reflection(1.5, 1.5), 0.0);
}

TEST(AcousticTable, AttenuationFollowsItsPowerOfFrequency) {
  AcousticTissue t;
  t.attenuation_db_per_cm_mhz = 0.5;
  t.attenuation_exponent = 1.5;
  EXPECT_NEAR(t.attenuation_db_per_cm(1.0), 0.5, 1e-12);
  EXPECT_NEAR(t.attenuation_db_per_cm(4.0), 4.0, 1e-12);
}

TEST(AcousticTable, ContrastVesselsAndLesionsAreDarkInLiver) {
  const AcousticTissue liver = tissue(shipped_acoustics(), "liver");
  EXPECT_EQ(liver.texture_db(0.0), 0.0);
  EXPECT_LE(liver.texture_db(40.0), -15.0);
  EXPECT_LE(liver.texture_db(-40.0), -4.0);
  EXPECT_GT(liver.texture_db(-40.0), liver.texture_db(40.0));
  EXPECT_EQ(liver.texture_db(1000.0), -kMostTexture_db);
}

/// Loads the shipped file with one text replaced.
Result<AcousticTable> load_changed_acoustics(const std::string& from, const std::string& to) {
  return testing::load_changed(kAcousticsFile, from, to, [](const auto& file) { return load_acoustic_table(file); });
}

TEST(AcousticTable, WrongEntryNamesFileTissueAndKey) {
  struct Case {
    std::string from, to, named;
  };
  const std::string liver = "[tissues.liver]\n";
  const std::vector<Case> cases = {
      {liver, liver + "loudness_db = {value = 1, source = \"x\"}\n", "loudness_db"},
      {"speed_m_per_s = {value = 1585,", "speed_mm_per_us = {value = 1.585,", "speed_m_per_s"},
      {"speed_m_per_s = {value = 1585,", "speed_m_per_s = {value = 158500,", "value"},
      {"backscatter_db = {value = 0, source = \"by definition\"}", "backscatter_db = {value = 0}", "source"},
      {"backscatter_db = {value = 0, source = \"by definition\"}", "backscatter_db = 0", "backscatter_db"},
      {"backscatter_db = {value = 0, source = \"by definition\"}", "backscatter_db = {value = 0, source = \"assumed\"}",
       "range"}};
  for (const Case& wrong : cases) {
    const auto table = load_changed_acoustics(wrong.from, wrong.to);
    ASSERT_FALSE(table) << wrong.to;
    const std::string text = table.error().text();
    EXPECT_NE(text.find("acoustics.toml"), std::string::npos) << text;
    EXPECT_NE(text.find("tissues.liver"), std::string::npos) << text;
    EXPECT_NE(text.find(wrong.named), std::string::npos) << text;
  }
}

TEST(AcousticTable, ReadsWalls) {
  const AcousticTable table = shipped_acoustics();
  ASSERT_FALSE(table.walls.empty());
  const AcousticWall& diaphragm = table.walls.front();
  EXPECT_EQ(diaphragm.name, "diaphragm");
  EXPECT_EQ(diaphragm.of, std::vector<std::uint8_t>{*table.find("lung")});
  EXPECT_GT(diaphragm.thickness_mm, 1.0);
}

TEST(AcousticTable, NamesTheWallThatIsWrong) {
  const std::pair<std::string, std::string> changes[] = {{"of = [\"lung\"]", "of = [\"lungs\"]"},
                                                         {"of = [\"lung\"]", "of = []"},
                                                         {"of = [\"lung\"]", "off = [\"lung\"]"},
                                                         {"thickness_mm = {value = 5,", "thickness_mm = {value = 50,"}};
  for (const auto& [from, to] : changes) {
    const auto table = load_changed_acoustics(from, to);
    ASSERT_FALSE(table) << to;
    EXPECT_NE(table.error().text().find("walls.diaphragm"), std::string::npos) << table.error().text();
  }
}

TEST(AcousticTable, RequiresAirFirst) {
  const auto table = load_changed_acoustics("[tissues.air]", "[tissues.vacuum]");
  ASSERT_FALSE(table);
  EXPECT_NE(table.error().text().find("air"), std::string::npos);
}

}  // namespace
}  // namespace trocar::ultrasound
