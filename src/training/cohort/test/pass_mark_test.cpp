#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cohort/separation.h"

namespace trocar::cohort {
namespace {

using Scores = std::vector<double>;

/// Three scores with this mean and standard deviation.
Scores around(double mean, double sd) {
  return {mean - sd, mean, mean + sd};
}

std::string reason(const Scores& experts, const Scores& novices) {
  const auto mark = contrasting_groups(experts, novices);
  return mark ? "none" : mark.error().text();
}

TEST(PassMark, IsTheMidpointForEqualSpreads) {
  const auto mark = contrasting_groups(around(80.0, 10.0), around(40.0, 10.0));
  ASSERT_TRUE(mark);
  EXPECT_NEAR(mark->value, 60.0, 1e-9);
  EXPECT_NEAR(mark->expected_false_pass, 0.0227501, 1e-7);  // two standard deviations
  EXPECT_NEAR(mark->expected_false_fail, 0.0227501, 1e-7);
  EXPECT_EQ(mark->false_passes, 0u);
  EXPECT_EQ(mark->false_fails, 0u);
  EXPECT_NEAR(mark->experts.sd, 10.0, 1e-12);
}

TEST(PassMark, IsTheIntersectionBetweenTheMeans) {
  // By hand: N(0, 1) and N(3, 2): x² - (x - 3)²/4 = 2 ln 2, 3x² + 6x - 9 - 8 ln 2 = 0, x = -1 ± sqrt(4 + 8/3 ln 2).
  const auto mark = contrasting_groups(around(3.0, 2.0), around(0.0, 1.0));
  ASSERT_TRUE(mark);
  EXPECT_NEAR(mark->value, -1.0 + std::sqrt(4.0 + 8.0 / 3.0 * std::log(2.0)), 1e-9);
}

TEST(PassMark, IsMirroredWithItsGroups) {
  const auto mark = contrasting_groups(around(70.0, 4.0), around(45.0, 12.0));
  const auto mirrored = contrasting_groups(around(-45.0, 12.0), around(-70.0, 4.0));
  ASSERT_TRUE(mark && mirrored);
  EXPECT_NEAR(mark->value, -mirrored->value, 1e-9);
  EXPECT_NEAR(mark->expected_false_pass, mirrored->expected_false_fail, 1e-9);
}

TEST(PassMark, ScalesWithTheScores) {
  const Scores experts{88.0, 91.0, 70.0}, novices{20.0, 55.0, 60.0, 41.0};
  Scores scaled_experts, scaled_novices;
  for (const double score : experts) scaled_experts.push_back(2.0 * score - 30.0);
  for (const double score : novices) scaled_novices.push_back(2.0 * score - 30.0);
  EXPECT_NEAR(contrasting_groups(scaled_experts, scaled_novices)->value,
              2.0 * contrasting_groups(experts, novices)->value - 30.0, 1e-9);
}

TEST(PassMark, CountsMisclassifiedPeople) {
  // Means 80 and 40, equal spread: the mark is 60.
  const auto mark = contrasting_groups(Scores{58.0, 80.0, 102.0}, Scores{18.0, 40.0, 62.0});
  ASSERT_TRUE(mark);
  EXPECT_NEAR(mark->value, 60.0, 1e-9);
  EXPECT_EQ(mark->false_passes, 1u);
  EXPECT_EQ(mark->false_fails, 1u);
}

TEST(PassMark, RefusesWithAReason) {
  EXPECT_NE(reason({}, around(40.0, 10.0)).find("at least 2 experts with a score, not 0"), std::string::npos);
  EXPECT_NE(reason({90.0}, around(40.0, 10.0)).find("at least 2 experts with a score, not 1"), std::string::npos);
  EXPECT_NE(reason(around(90.0, 3.0), {50.0}).find("at least 2 novices with a score, not 1"), std::string::npos);
  EXPECT_NE(reason({99.0, 99.0}, around(40.0, 10.0)).find("all experts have the same score (99.0)"), std::string::npos);
  EXPECT_NE(reason(around(40.0, 10.0), around(40.0, 12.0)).find("not above"), std::string::npos);
  EXPECT_NE(reason(around(30.0, 10.0), around(40.0, 12.0)).find("not above"), std::string::npos);
  // The wide distribution is below the narrow one at both means.
  EXPECT_NE(reason(around(42.0, 40.0), around(40.0, 5.0)).find("overlap too much"), std::string::npos);
  EXPECT_NE(reason({90.0, std::numeric_limits<double>::quiet_NaN()}, around(40.0, 10.0)).find("not a number"),
            std::string::npos);
}

}  // namespace
}  // namespace trocar::cohort
