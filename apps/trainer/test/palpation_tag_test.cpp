#include "panels/palpation_tag.h"

#include <gtest/gtest.h>

namespace trocar::trainer {
namespace {

haptics::Palpation felt(double stiffness_n_per_mm, std::optional<double> bone_mm) {
  haptics::Palpation palpation;
  palpation.force_n = haptics::kPalpating_n;
  palpation.stiffness_n_per_mm = stiffness_n_per_mm;
  palpation.bone_mm = bone_mm;
  return palpation;
}

TEST(PalpationTag, NamesHardnessAndTheBoneBelow) {
  EXPECT_EQ(PalpationTag::words_of(felt(5.0, 6.2), true), QStringLiteral("Hard: bone 6 mm below the skin"));
  EXPECT_TRUE(PalpationTag::words_of(felt(0.1, {}), true).startsWith(QStringLiteral("Soft: no bone")));
}

TEST(PalpationTag, ShowsOnlyTheHardnessInAnExam) {
  EXPECT_EQ(PalpationTag::words_of(felt(5.0, 6.2), false), QStringLiteral("Hard"));
  EXPECT_EQ(PalpationTag::words_of(felt(haptics::kFirm_n_per_mm, {}), false), QStringLiteral("Firm"));
}

TEST(PalpationTag, FitsItsText) {
  PalpationTag tag;
  EXPECT_TRUE(tag.isHidden());
  tag.show_felt(felt(5.0, 18.0), true);
  EXPECT_GT(tag.width(), tag.fontMetrics().horizontalAdvance(tag.words()));
  EXPECT_TRUE(tag.testAttribute(Qt::WA_TransparentForMouseEvents));
}

}  // namespace
}  // namespace trocar::trainer
