#include "anatomy/structure_words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace trocar::anatomy {
namespace {

TEST(StructureWords, PutTheSideInFront) {
  EXPECT_EQ(structure_words("rib_right_10"), "right rib 10");
  EXPECT_EQ(structure_words("kidney_left"), "left kidney");
  EXPECT_EQ(structure_words("left_lung"), "left lung");
  EXPECT_EQ(structure_words("liver_capsule"), "liver capsule");
  EXPECT_EQ(structure_words("vertebrae_L1"), "vertebra L1");
  EXPECT_EQ(structure_words("right"), "right");
  EXPECT_EQ(structure_words("a__b_"), "a b");
  EXPECT_EQ(structure_words(""), "");
}

TEST(StructureWords, NameThePuncturedLayer) {
  EXPECT_EQ(layer_words("muscle"), "muscle fascia");
  EXPECT_EQ(layer_words("vessel"), "vessel wall");
  EXPECT_EQ(layer_words("skin"), "skin");
  EXPECT_EQ(layer_words("liver_capsule"), "liver capsule");
}

TEST(StructureWords, NumbersInNamesAreOrderedByTheirValue) {
  std::vector<std::string> names{"rib_left_12",   "vertebrae_T9", "rib_left_5",
                                 "rib",           "rib_left_10",  "rib_left_05",
                                 "vertebrae_T10", "vertebrae_L1", "rib_left_99999999999999999999"};
  std::sort(names.begin(), names.end(), is_name_before);
  EXPECT_EQ(names, (std::vector<std::string>{"rib", "rib_left_05", "rib_left_5", "rib_left_10", "rib_left_12",
                                             "rib_left_99999999999999999999", "vertebrae_L1", "vertebrae_T9",
                                             "vertebrae_T10"}));
  for (const std::string& a : names) EXPECT_FALSE(is_name_before(a, a)) << a;
}

}  // namespace
}  // namespace trocar::anatomy
