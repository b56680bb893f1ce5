#include <gtest/gtest.h>

#include <cmath>

#include "cohort/learning_curve.h"
#include "core/random.h"

namespace trocar::cohort {
namespace {

std::vector<FollowUp> people(const std::vector<double>& reached, const std::vector<double>& censored) {
  std::vector<FollowUp> all;
  for (const double time : reached) all.push_back({time, true});
  for (const double time : censored) all.push_back({time, false});
  return all;
}

// Acute myelogenous leukaemia, data set aml of R's package survival; print(survfit(Surv(time, status) ~ x)) gives
// 11 7 31 18 NA and 12 11 23 8 NA.
TEST(Survival, MatchesTheMediansOfR) {
  const auto maintained = survival_of(people({9, 13, 18, 23, 31, 34, 48}, {13, 28, 45, 161}));
  ASSERT_TRUE(maintained) << maintained.error().text();
  EXPECT_EQ(maintained->people, 11u);
  EXPECT_EQ(maintained->reached, 7u);
  EXPECT_EQ(maintained->censored(), 4u);
  EXPECT_EQ(maintained->median, 31.0);
  EXPECT_EQ(maintained->low, 18.0);
  EXPECT_FALSE(maintained->high);
  const auto others = survival_of(people({5, 5, 8, 8, 12, 23, 27, 30, 33, 43, 45}, {16}));
  ASSERT_TRUE(others);
  EXPECT_EQ(others->median, 23.0);
  EXPECT_EQ(others->low, 8.0);
  EXPECT_FALSE(others->high);
}

TEST(Survival, MatchesTheDefinition) {
  const auto found = survival_of(people({2, 3, 3, 6}, {3, 4}));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->steps.size(), 3u);
  EXPECT_DOUBLE_EQ(found->steps[0].open_share, 5.0 / 6.0);
  EXPECT_EQ(found->steps[1].at_risk, 5u);
  EXPECT_EQ(found->steps[1].reached, 2u);
  EXPECT_DOUBLE_EQ(found->steps[1].open_share, 5.0 / 6.0 * 3.0 / 5.0);  // who stops at 3 was followed until 3
  EXPECT_EQ(found->steps[2].at_risk, 1u);
  EXPECT_EQ(found->steps[2].open_share, 0.0);
  EXPECT_EQ(found->median, 3.0);
}

TEST(Survival, MedianWithoutCensoringIsTheSampleMedian) {
  EXPECT_EQ(survival_of(people({1, 2, 3, 4, 5}, {}))->median, 3.0);
  EXPECT_EQ(survival_of(people({1, 2, 3, 4}, {}))->median, 2.0);
}

TEST(Survival, HasNoMedianIfMostAreCensored) {
  const auto found = survival_of(people({4}, {9, 9, 9}));
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->median);
  EXPECT_EQ(found->censored(), 3u);
  EXPECT_FALSE(survival_of(people({}, {5, 6}))->median);
  EXPECT_TRUE(survival_of(people({}, {5, 6}))->steps.empty());
}

TEST(Survival, CensoringRaisesTheMedian) {
  // Ignoring the three who never got there would give 3.
  EXPECT_EQ(survival_of(people({2, 3, 4, 8}, {20, 20, 20}))->median, 8.0);
}

TEST(Survival, MedianLiesWithinItsInterval) {
  // Geometric numbers of trials with p = 0.2 (median 4), followed for 3 to 12 trials: 1000 studies of 20 people.
  Random random(7);
  int held = 0;
  for (int study = 0; study < 1000; ++study) {
    std::vector<FollowUp> all;
    for (int n = 0; n < 20; ++n) {
      const double most = std::floor(random.uniform(3.0, 13.0));
      double trial = 1.0;
      while (random.uniform() >= 0.2) ++trial;
      all.push_back({std::min(trial, most), trial <= most});
    }
    const auto found = survival_of(all);
    ASSERT_TRUE(found);
    held += found->low && *found->low <= 4.0 && (!found->high || *found->high >= 4.0) ? 1 : 0;
  }
  EXPECT_GT(held, 920);
}

TEST(Survival, RefusesEmptyInputAndInvalidTimes) {
  EXPECT_FALSE(survival_of({}));
  EXPECT_FALSE(survival_of(people({std::nan("")}, {})));
  EXPECT_FALSE(survival_of(people({-1.0}, {2.0})));
  EXPECT_FALSE(survival_of(people({INFINITY}, {})));
}

}  // namespace
}  // namespace trocar::cohort
