#include "anatomy/known_structures.h"

#include <gtest/gtest.h>

#include <cctype>
#include <set>
#include <string>

#include "anatomy/testing/shipped_structures.h"
#include "anatomy/testing/shipped_tissues.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/testing/user_locale.h"

namespace trocar::anatomy {
namespace {

const KnownStructures& known() {
  static const KnownStructures kKnown = trocar::testing::shipped_structures();
  return kKnown;
}

std::string tissue_of(std::string_view name) {
  const KnownStructure* structure = known().find(name);
  return structure != nullptr ? structure->tissue : "";
}

const std::string& totalsegmentator_name(std::size_t number) {
  return known().totalsegmentator_names().at(number - 1);
}

TEST(Totalsegmentator, NumbersMatchTheClassMap) {
  EXPECT_EQ(totalsegmentator_name(1), "spleen");
  EXPECT_EQ(totalsegmentator_name(5), "liver");
  EXPECT_EQ(totalsegmentator_name(25), "sacrum");
  EXPECT_EQ(totalsegmentator_name(50), "vertebrae_C1");
  EXPECT_EQ(totalsegmentator_name(64), "portal_vein_and_splenic_vein");
  EXPECT_EQ(totalsegmentator_name(92), "rib_left_1");
  EXPECT_EQ(totalsegmentator_name(115), "rib_right_12");
  EXPECT_EQ(totalsegmentator_name(117), "costal_cartilages");
  EXPECT_EQ(known().totalsegmentator_names().size(), 117U);
}

TEST(Totalsegmentator, NamesAreUniqueAndKnown) {
  std::set<std::string> names;
  for (const std::string& name : known().totalsegmentator_names()) {
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_NE(known().find(name), nullptr) << name;
  }
}

TEST(KnownStructures, TissueFollowsTheName) {
  EXPECT_EQ(tissue_of("rib_left_5"), "bone");
  EXPECT_EQ(tissue_of("rib_right_12"), "bone");
  EXPECT_EQ(tissue_of("vertebrae_L5"), "bone");
  EXPECT_EQ(tissue_of("costal_cartilages"), "cartilage");
  EXPECT_EQ(tissue_of("lung_middle_lobe_right"), "lung");
  EXPECT_EQ(tissue_of("autochthon_left"), "muscle");
  EXPECT_EQ(tissue_of("iliac_vena_right"), "vessel");
  EXPECT_EQ(tissue_of("kidney_cyst_left"), "fluid");
  EXPECT_EQ(tissue_of("adrenal_gland_right"), "organ");
  EXPECT_EQ(tissue_of("esophagus"), "bowel");
  EXPECT_EQ(tissue_of("spinal_cord"), "nerve");
  EXPECT_EQ(tissue_of("fat"), "adipose");
}

TEST(KnownStructures, IncludeTheLayersOfAllPuncturePaths) {
  for (const auto& [name, tissue] :
       std::initializer_list<std::pair<const char*, const char*>>{{"supraspinous_ligament", "ligament"},
                                                                  {"interspinous_ligament", "ligament"},
                                                                  {"ligamentum_flavum", "ligamentum_flavum"},
                                                                  {"epidural_fat", "adipose"},
                                                                  {"dura", "csf"},
                                                                  {"csf", "csf"},
                                                                  {"spinal_canal", "csf"},
                                                                  {"bile_duct", "bile_duct"},
                                                                  {"biliarysystem", "bile_duct"},
                                                                  {"peritoneum", "peritoneum"},
                                                                  {"ascites", "ascites"}})
    EXPECT_EQ(tissue_of(name), tissue) << name;
}

TEST(KnownStructures, IncludeTheMaskNamesOf3dIrcadb) {
  for (const auto& [name, tissue] :
       std::initializer_list<std::pair<const char*, const char*>>{{"liver", "liver"},
                                                                  {"livertumor1", "liver_lesion"},
                                                                  {"livertumor02", "liver_lesion"},
                                                                  {"livertumour", "liver_lesion"},
                                                                  {"liverkyst", "fluid"},
                                                                  {"portalvein", "vessel"},
                                                                  {"portalvein1", "vessel"},
                                                                  {"venoussystem", "vessel"},
                                                                  {"venacava", "vessel"},
                                                                  {"artery", "vessel"},
                                                                  {"bone", "bone"},
                                                                  {"skin", "skin"},
                                                                  {"lungs", "lung"},
                                                                  {"rightlung", "lung"},
                                                                  {"leftkidney", "kidney"},
                                                                  {"kidneys", "kidney"},
                                                                  {"smallintestin", "bowel"},
                                                                  {"surrenalgland", "organ"}})
    EXPECT_EQ(tissue_of(name), tissue) << name;
}

TEST(KnownStructures, CaseSeparatorsAndSideDoNotMatter) {
  for (const char* name : {"Liver Tumor 1", "LIVER-TUMOR", "liver_tumor_12"})
    EXPECT_EQ(tissue_of(name), "liver_lesion") << name;
  EXPECT_EQ(tissue_of("Left Kidney"), "kidney");
}

TEST(KnownStructures, TreatASidedVentricleAsOfTheHeart) {
  for (const char* name : {"Left Ventricle", "ventricle_right", "right ventricle 1", "Left_Ventricle_Cavity",
                           "left ventricle of heart", "heart_ventricle_left"})
    EXPECT_EQ(tissue_of(name), "organ") << name;
  for (const char* name :
       {"ventricle", "Ventricles", "left lateral ventricle", "Left-Inferior-Lateral-Ventricle", "third ventricle",
        "fourth_ventricle", "ventricle_body_left", "ventricle_frontal_horn_right", "brain ventricle left"})
    EXPECT_EQ(tissue_of(name), "csf") << name;
  EXPECT_EQ(known().find("ventricle_l"), nullptr);
}

TEST(KnownStructures, AreFoundInATurkishLocale) {
  const trocar::testing::UserLocale user("tr_TR.UTF-8");
  if (!user.is_there()) GTEST_SKIP() << "tr_TR.UTF-8 is not on this machine";
  const volatile int small = (std::tolower)('I');  // the compiler takes it for no capital letter
  ASSERT_EQ(int{small}, 'I') << "the test must see the Turkish letters";
  EXPECT_EQ(tissue_of("LIVER"), "liver");
  EXPECT_EQ(tissue_of("Inferior vena cava"), tissue_of("inferior_vena_cava"));
  EXPECT_NE(known().find("INFERIOR_VENA_CAVA"), nullptr);
}

TEST(KnownStructures, UnknownNamesAreNotGuessed) {
  for (const char* name : {"", "left", "livre", "liver2x", "my_structure", "rib_five", "boneless", "5"})
    EXPECT_EQ(known().find(name), nullptr) << name;
}

TEST(KnownStructures, GiveInnerStructuresPriority) {
  const auto priority = [](std::string_view name) { return known().find(name)->priority; };
  EXPECT_GT(priority("livertumor1"), priority("portalvein"));
  EXPECT_GT(priority("portalvein"), priority("liver"));
  EXPECT_GT(priority("aorta"), priority("inferior_vena_cava"));
  EXPECT_GT(priority("bone"), priority("autochthon_left"));
  EXPECT_GT(priority("spinal_cord"), priority("vertebrae_L1"));
  EXPECT_GT(priority("spinal_cord"), priority("dura"));
  EXPECT_GT(priority("dura"), priority("epidural_fat"));
  EXPECT_GT(priority("bile_duct"), priority("liver"));
  EXPECT_GT(priority("liver"), priority("lungs"));
  EXPECT_GT(priority("kidney_cyst_left"), priority("kidney_left"));
}

TEST(KnownStructures, BackgroundHasManyNames) {
  for (const char* name : {"background", "Background", "air", "Clear Label", "clear_label", "exterior", "unlabeled"})
    EXPECT_TRUE(known().is_background(name)) << name;
  for (const char* name : {"liver", "airway", "lung", "clear cell carcinoma", ""})
    EXPECT_FALSE(known().is_background(name)) << name;
}

TEST(KnownStructures, SuggestTheNameForATypingError) {
  EXPECT_EQ(known().similar_names("livr", 1), std::vector<std::string>{"liver"});
  EXPECT_EQ(known().similar_names("vertebra_L6", 1).at(0).substr(0, 9), "vertebrae");
  EXPECT_EQ(known().similar_names("kidny_left", 1), std::vector<std::string>{"kidney_left"});
  EXPECT_LE(known().similar_names("liver_tumour", 3).size(), 3u);
  for (const char* far : {"qqqqqqqqqqqq", "my_roi", "roi", "foo", "label_1", "PTV", "contour"})
    EXPECT_TRUE(known().similar_names(far).empty()) << far << ": " << known().similar_names(far).front();
}

TEST(KnownStructures, EveryTissueIsInTheTissueTable) {
  const TissueTable table = trocar::testing::shipped_tissues();
  for (const std::string& name : known().totalsegmentator_names())
    EXPECT_TRUE(table.find_tissue(tissue_of(name))) << name;
  for (const char* name : {"livertumor", "ascites", "peritoneum", "dura", "ligamentumflavum", "ligament", "bileduct",
                           "fat", "muscle", "softtissue", "gas"})
    EXPECT_TRUE(table.find_tissue(tissue_of(name))) << name;
}

constexpr std::string_view kStructures = R"(background = ["air"]
[priorities]
bone = 50
[colours]
ivory = [232, 220, 190]
[[structures]]
names = ["rib#"]
tissue = "bone"
colour = "ivory"
priority = "bone"
)";
constexpr std::string_view kLabels = "[labels]\n1 = \"rib_1\"\n2 = \"rib_2\"\n";

/// What is loaded from a folder with these two files.
Result<KnownStructures> load(std::string_view structures, std::string_view labels) {
  const TemporaryFolder folder;
  EXPECT_TRUE(write_file_atomically(folder / "structures.toml", structures));
  EXPECT_TRUE(write_file_atomically(folder / "totalsegmentator.toml", labels));
  return KnownStructures::load(folder.path());
}

TEST(KnownStructures, LoadMatchesTheFiles) {
  const auto few = load(kStructures, kLabels);
  ASSERT_TRUE(few) << few.error().text();
  ASSERT_NE(few->find("Rib_left_7"), nullptr);
  EXPECT_EQ(few->find("rib")->tissue, "bone");
  EXPECT_EQ(few->find("rib")->color, (image::Rgb{232, 220, 190}));
  EXPECT_EQ(few->find("rib")->priority, 50);
  EXPECT_EQ(few->find("liver"), nullptr);
  EXPECT_TRUE(few->is_background("Air"));
  EXPECT_EQ(few->totalsegmentator_names(), (std::vector<std::string>{"rib_1", "rib_2"}));
}

TEST(KnownStructures, AMissingFileIsNamed) {
  const TemporaryFolder folder;
  const auto none = KnownStructures::load(folder.path());
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().where.find("structures.toml"), std::string::npos);
  ASSERT_TRUE(write_file_atomically(folder / "structures.toml", kStructures));
  const auto half = KnownStructures::load(folder.path());
  ASSERT_FALSE(half);
  EXPECT_NE(half.error().where.find("totalsegmentator.toml"), std::string::npos);
}

TEST(KnownStructures, RefuseMalformedRowsWithTheirLocation) {
  struct Change {
    std::string_view from, to, message;
  };
  for (const Change& change :
       std::initializer_list<Change>{{"\"rib#\"", "", "no name"},
                                     {"\"rib#\"", "\"rib#\", \"Rib_#\"", "occurs twice"},
                                     {"rib#", "left_rib", "no structure can have"},
                                     {"rib#", "#", "no structure can have"},
                                     {"rib#", "r#b", "no structure can have"},
                                     {"rib#", "rib%", "no structure can have"},
                                     {"rib#", "r\u00efb", "no structure can have"},
                                     {"tissue = \"bone\"", "", "tissue"},
                                     {"colour = \"ivory\"", "colour = \"ivry\"", "no colour \"ivry\""},
                                     {"priority = \"bone\"", "priority = \"bon\"", "no priority \"bon\""},
                                     {"priority = \"bone\"", "prioriti = \"bone\"", "did you mean \"priority\""},
                                     {"bone = 50", "bone = 50.5", "a whole number"},
                                     {"bone = 50", "bone = -1", "priorities.bone"},
                                     {"220, 190", "220", "three whole numbers"},
                                     {"220, 190", "220.5, 190", "three whole numbers"},
                                     {"220, 190", "256, 190", "colours.ivory"},
                                     {"220, 190", "nan, 190", "colours.ivory"},
                                     {"[[structures]]", "[structures]", "structures"}}) {
    std::string text(kStructures);
    text.replace(text.find(change.from), change.from.size(), change.to);
    const auto broken = load(text, kLabels);
    ASSERT_FALSE(broken) << change.to;
    EXPECT_NE(broken.error().text().find(change.message), std::string::npos) << broken.error().text();
    EXPECT_NE(broken.error().text().find("structures.toml"), std::string::npos) << broken.error().text();
  }
  for (const char* labels : {"", "[labels]\n2 = \"rib_2\"\n", "[labels]\n1 = \"rib_1\"\n2 = \"rib_1\"\n",
                             "[labels]\n1 = 5\n", "[labels]\n1 = \"rib\"\n[more]\n", "[labels]\none = \"rib\"\n"}) {
    const auto broken = load(kStructures, labels);
    ASSERT_FALSE(broken) << labels;
    EXPECT_NE(broken.error().text().find("totalsegmentator.toml"), std::string::npos) << broken.error().text();
  }
}

}  // namespace
}  // namespace trocar::anatomy
