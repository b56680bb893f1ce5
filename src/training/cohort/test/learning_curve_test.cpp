#include "cohort/learning_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.h"

namespace trocar::cohort {
namespace {

using AttemptScores = std::vector<std::optional<double>>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(MovingMean, IsTheMeanOfTheLastScoredAttempts) {
  const AttemptScores scores{10.0, 20.0, std::nullopt, 60.0, 100.0};
  EXPECT_EQ(moving_mean(scores, 2), (AttemptScores{10.0, 15.0, 15.0, 40.0, 80.0}));
  EXPECT_EQ(moving_mean(scores, 1), (AttemptScores{10.0, 20.0, 20.0, 60.0, 100.0}));
  EXPECT_EQ(moving_mean(scores, 100).back(), 47.5);
}

TEST(MovingMean, IsEmptyBeforeTheFirstScore) {
  EXPECT_EQ(moving_mean(AttemptScores{std::nullopt, kNan, 5.0}, 3), (AttemptScores{std::nullopt, std::nullopt, 5.0}));
  EXPECT_TRUE(moving_mean({}, 3).empty());
}

TEST(Trend, IsTheSlopeOfALineDespiteAnOutlier) {
  AttemptScores scores;
  for (int n = 0; n < 9; ++n) scores.emplace_back(40.0 + 3.0 * n);
  EXPECT_DOUBLE_EQ(*trend_per_attempt(scores), 3.0);
  scores[4].reset();
  EXPECT_DOUBLE_EQ(*trend_per_attempt(scores), 3.0) << "attempts without a score keep their number";
  scores[7] = 0.0;
  EXPECT_DOUBLE_EQ(*trend_per_attempt(scores), 3.0);
}

TEST(Trend, NeedsThreeScores) {
  EXPECT_FALSE(trend_per_attempt(AttemptScores{1.0, std::nullopt, 2.0, kNan}));
  EXPECT_EQ(trend_per_attempt(AttemptScores{5.0, 5.0, 5.0}), 0.0);
}

TEST(Cusum, MatchesThePublishedStepAndLimits) {
  // 10 and 20 %, risks of 0.1, by hand: P = ln 2 = 0.6931, Q = ln 1.125 = 0.1178, ln 9 = 2.1972.
  const auto cusum = cusum_of({false, true, true}, {0.1, 0.2, 0.1, 0.1});
  ASSERT_TRUE(cusum);
  EXPECT_NEAR(cusum->pass_step, 0.1452, 5e-5);
  EXPECT_NEAR(cusum->upper, 2.7095, 5e-4);
  EXPECT_NEAR(cusum->lower, -2.7095, 5e-4);
  ASSERT_EQ(cusum->values.size(), 3u);
  EXPECT_NEAR(cusum->values[0], 0.8548, 5e-5);
  EXPECT_NEAR(cusum->values[1], 0.7095, 5e-5);
  EXPECT_NEAR(cusum->values[2], 0.5643, 5e-5);
  EXPECT_TRUE(cusum->signals.empty());
}

TEST(Cusum, DecidesAtALimitAndRestarts) {
  // 20 and 40 %: s = 0.2933, limits ± 2.24: 4 failures (2.83) or 8 passes (-2.35) in a row decide.
  std::vector<bool> passed(4, false);
  passed.insert(passed.end(), 16, true);
  const auto cusum = cusum_of(passed);
  ASSERT_TRUE(cusum);
  ASSERT_EQ(cusum->signals.size(), 3u);
  EXPECT_EQ(cusum->signals[0].attempt, 4u);
  EXPECT_EQ(cusum->signals[0].decision, Cusum::Decision::kUnacceptable);
  EXPECT_EQ(cusum->signals[1].attempt, 12u);
  EXPECT_EQ(cusum->signals[1].decision, Cusum::Decision::kAcceptable);
  EXPECT_EQ(cusum->signals[2].attempt, 20u);
  EXPECT_GE(cusum->values[3], cusum->upper);
  EXPECT_DOUBLE_EQ(cusum->values[4], -cusum->pass_step) << "a new test begins at 0";
}

/// Share of 3000 people with this failure rate whose first decision is the given one.
double share_deciding(double failure_rate, Cusum::Decision decision) {
  constexpr int kPeople = 3000, kAttempts = 400;
  int decided = 0;
  for (int person = 0; person < kPeople; ++person) {
    Random random(static_cast<std::uint64_t>(person) + 1);
    std::vector<bool> passed;
    for (int n = 0; n < kAttempts; ++n) passed.push_back(random.uniform() >= failure_rate);
    const auto cusum = cusum_of(passed);
    EXPECT_TRUE(cusum && !cusum->signals.empty());
    if (cusum->signals.front().decision == decision) ++decided;
  }
  return static_cast<double>(decided) / kPeople;
}

TEST(Cusum, MatchesWaldsErrorRisks) {
  // Wald 1945: the risks are at most alpha / (1 - beta) and beta / (1 - alpha), here 1/9; 3 standard errors are 0.017.
  EXPECT_LT(share_deciding(0.2, Cusum::Decision::kUnacceptable), 1.0 / 9.0 + 0.017);
  EXPECT_LT(share_deciding(0.4, Cusum::Decision::kAcceptable), 1.0 / 9.0 + 0.017);
  EXPECT_GT(share_deciding(0.05, Cusum::Decision::kAcceptable), 0.97);
}

TEST(Cusum, ExchangesItsSidesWithPassAndFail) {
  // Testing passes instead of failures: rates 1 - p1 and 1 - p0, risks exchanged. The same test upside down.
  const std::vector<bool> passed{true, false, true, true, false, false, true};
  std::vector<bool> failed = passed;
  failed.flip();
  const auto a = cusum_of(passed, {0.3, 0.5, 0.05, 0.2}), b = cusum_of(failed, {0.5, 0.7, 0.2, 0.05});
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(a->lower, -b->upper, 1e-12);
  EXPECT_NEAR(a->upper, -b->lower, 1e-12);
  for (std::size_t n = 0; n < passed.size(); ++n) EXPECT_NEAR(a->values[n], -b->values[n], 1e-12) << n;
}

TEST(Cusum, RefusesInvalidRates) {
  for (const CusumRates& rates :
       {CusumRates{0.4, 0.2, 0.1, 0.1}, CusumRates{0.2, 0.2, 0.1, 0.1}, CusumRates{0.0, 0.2, 0.1, 0.1},
        CusumRates{0.2, 1.0, 0.1, 0.1}, CusumRates{0.2, 0.4, 0.5, 0.1}, CusumRates{0.2, 0.4, 0.1, kNan},
        CusumRates{kNan, 0.4, 0.1, 0.1}}) {
    const auto cusum = cusum_of({true}, rates);
    ASSERT_FALSE(cusum);
    EXPECT_EQ(cusum.error().exit_status, 2);
    EXPECT_NE(cusum.error().text().find("CUSUM"), std::string::npos);
  }
}

TEST(MeanCurve, CountsThePeopleOfEachAttempt) {
  const std::vector<AttemptScores> people{
      {10.0, 20.0, 30.0}, {30.0, std::nullopt, std::nullopt, std::nullopt, 50.0}, {}};
  const auto curve = mean_curve(people);
  ASSERT_EQ(curve.size(), 5u);
  EXPECT_EQ(curve[0]->people, 2u);
  EXPECT_EQ(curve[0]->mean, 20.0);
  EXPECT_EQ(curve[1]->people, 1u);
  EXPECT_EQ(curve[1]->mean, 20.0);
  EXPECT_FALSE(curve[1]->interval);
  EXPECT_FALSE(curve[3]);
  EXPECT_EQ(curve[4]->mean, 50.0);
  EXPECT_TRUE(mean_curve({}).empty());
}

TEST(MeanCurve, UsesStudentsInterval) {
  const std::vector<AttemptScores> people{{10.0}, {30.0}};
  const auto curve = mean_curve(people);
  // Two values: t = 12.706, standard error 10.
  EXPECT_NEAR(curve[0]->interval->low, 20.0 - 127.06, 0.01);
  EXPECT_NEAR(curve[0]->interval->high, 20.0 + 127.06, 0.01);
}

}  // namespace
}  // namespace trocar::cohort
