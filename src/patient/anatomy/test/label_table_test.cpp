#include "anatomy/label_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace trocar::anatomy {
namespace {

std::string tissue_of(std::string_view name) {
  const auto known = find_known_structure(name);
  return known ? std::string(known->tissue) : "";
}

TEST(LabelTable, FindsByIdAndByName) {
  LabelTable table;
  table.labels = {{2, "liver", "liver", {1, 2, 3}}, {7, "fat", "adipose", {4, 5, 6}}};
  ASSERT_NE(table.find(std::uint8_t{7}), nullptr);
  EXPECT_EQ(table.find(std::uint8_t{7})->name, "fat");
  ASSERT_NE(table.find("liver"), nullptr);
  EXPECT_EQ(table.find("liver")->id, 2);
  for (const int absent : {0, 1, 3, 8, 255}) EXPECT_EQ(table.find(static_cast<std::uint8_t>(absent)), nullptr);
  EXPECT_EQ(table.find("Liver"), nullptr);
}

TEST(Totalsegmentator, NumbersAreThoseOfTheClassMap) {
  EXPECT_EQ(totalsegmentator_name(1), "spleen");
  EXPECT_EQ(totalsegmentator_name(5), "liver");
  EXPECT_EQ(totalsegmentator_name(25), "sacrum");
  EXPECT_EQ(totalsegmentator_name(50), "vertebrae_C1");
  EXPECT_EQ(totalsegmentator_name(64), "portal_vein_and_splenic_vein");
  EXPECT_EQ(totalsegmentator_name(92), "rib_left_1");
  EXPECT_EQ(totalsegmentator_name(115), "rib_right_12");
  EXPECT_EQ(totalsegmentator_name(117), "costal_cartilages");
  for (const int beyond : {-1, 0, 118}) EXPECT_FALSE(totalsegmentator_name(beyond).has_value());
}

TEST(Totalsegmentator, EveryNameIsDifferentAndKnown) {
  std::set<std::string_view> names;
  for (int number = 1; number <= 117; ++number) {
    const std::string_view name = *totalsegmentator_name(number);
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_TRUE(find_known_structure(name).has_value()) << name;
  }
}

TEST(KnownStructure, TissueFollowsTheName) {
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

TEST(KnownStructure, KnowsWhatLiesOnThePathsOfSpineBileDuctAndAscites) {
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

TEST(KnownStructure, KnowsTheMaskNamesOf3dIrcadb) {
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

TEST(LabelTable, FindsTheOrganOfEachLesion) {
  LabelTable table;
  table.labels = {{2, "livertumor1", "liver_lesion", {}},
                  {5, "liver", "liver", {}},
                  {6, "liver_segment_2", "liver", {}},
                  {7, "lung_tumour", "lung_lesion", {}}};
  const auto shown = lesions_as_organs(table);
  EXPECT_EQ(shown[2], 5);
  EXPECT_EQ(shown[7], 0);
  for (const std::size_t id : {0U, 1U, 5U, 6U, 255U}) EXPECT_EQ(shown[id], id);
}

TEST(KnownStructure, CaseSeparatorsAndSideDoNotMatter) {
  for (const char* name : {"Liver Tumor 1", "LIVER-TUMOR", "liver_tumor_12"})
    EXPECT_EQ(tissue_of(name), "liver_lesion") << name;
  EXPECT_EQ(tissue_of("Left Kidney"), "kidney");
}

TEST(KnownStructure, UnknownNamesAreNotGuessed) {
  for (const char* name : {"", "left", "livre", "liver2x", "my_structure", "rib_five", "boneless", "5"})
    EXPECT_FALSE(find_known_structure(name).has_value()) << name;
}

TEST(KnownStructure, WhatLiesInsideAnotherWins) {
  const auto priority = [](std::string_view name) { return find_known_structure(name)->priority; };
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

TEST(KnownStructure, BackgroundHasManyNames) {
  for (const char* name : {"background", "Background", "air", "Clear Label", "clear_label", "exterior", "unlabeled"})
    EXPECT_TRUE(is_background_name(name)) << name;
  for (const char* name : {"liver", "airway", "lung", "clear cell carcinoma", ""})
    EXPECT_FALSE(is_background_name(name)) << name;
}

TEST(KnownStructure, ATypingErrorFindsTheNameMeant) {
  EXPECT_EQ(similar_structure_names("livr", 1), std::vector<std::string>{"liver"});
  EXPECT_EQ(similar_structure_names("vertebra_L6", 1).at(0).substr(0, 9), "vertebrae");
  EXPECT_EQ(similar_structure_names("kidny_left", 1), std::vector<std::string>{"kidney_left"});
  EXPECT_LE(similar_structure_names("liver_tumour", 3).size(), 3u);
  for (const char* far : {"qqqqqqqqqqqq", "my_roi", "roi", "foo", "label_1", "PTV", "contour"})
    EXPECT_TRUE(similar_structure_names(far).empty()) << far << ": " << similar_structure_names(far).front();
}

}  // namespace
}  // namespace trocar::anatomy
