#include "anatomy/structure_words.h"

#include <gtest/gtest.h>

namespace trocar {
namespace {

TEST(StructureWords, PutTheSideInFront) {
  EXPECT_EQ(structure_words("rib_right_10"), "right rib 10");
  EXPECT_EQ(structure_words("kidney_left"), "left kidney");
  EXPECT_EQ(structure_words("left_lung"), "left lung");
  EXPECT_EQ(structure_words("liver_capsule"), "liver capsule");
  EXPECT_EQ(structure_words("vertebrae_L1"), "vertebrae L1");
  EXPECT_EQ(structure_words("right"), "right");
  EXPECT_EQ(structure_words("a__b_"), "a b");
  EXPECT_EQ(structure_words(""), "");
}

}  // namespace
}  // namespace trocar
