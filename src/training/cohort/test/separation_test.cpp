#include "cohort/separation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.h"

namespace trocar::cohort {
namespace {

using Values = std::vector<double>;

// Hollander and Wolfe 1973, table 4.1: permeability of the chorioamnion at term and at 12 to 26 weeks.
const Values kAtTerm{0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46};
const Values kEarly{1.15, 0.88, 0.90, 0.74, 1.21};

TEST(RankSum, HasThePublishedExactP) {
  const auto test = rank_sum_test(kAtTerm, kEarly);
  ASSERT_TRUE(test);
  EXPECT_DOUBLE_EQ(test->u, 35.0);
  EXPECT_NEAR(test->p, 2.0 * 0.1272061, 1e-7);
  EXPECT_TRUE(test->is_exact);
}

TEST(RankSum, HasThePublishedApproximatePWithTies) {
  // R: wilcox.test(x, y) gives W = 51.5, p = 0.5966; and W = 0, p = 0.001364 for the second pair.
  const Values x{1, 5, 9, 24, 56, 21, 3, 7, 21, 4}, y{12, 15, 5, 9, 9, 14, 56, 22, 3, 7, 32, 5};
  const auto test = rank_sum_test(x, y, 0);
  ASSERT_TRUE(test);
  EXPECT_DOUBLE_EQ(test->u, 51.5);
  EXPECT_NEAR(test->p, 0.5966, 5e-5);
  EXPECT_FALSE(test->is_exact);
  const Values larger{1233, 4356, 987, 39999, 1111, 200000};
  EXPECT_NEAR(rank_sum_test(x, larger, 0)->p, 0.001364, 1e-6);
  EXPECT_NEAR(rank_sum_test(x, larger)->p, 2.0 / 8008.0, 1e-12) << "C(16, 6) choices";
}

TEST(RankSum, MatchesAManualCalculationWithTies) {
  // Values 1 1 2 2 over groups of 2: of the 6 choices, 1 has the sum of 2 2, 1 that of 1 1, 4 the mean.
  EXPECT_NEAR(rank_sum_test(Values{2, 2}, Values{1, 1})->p, 2.0 / 6.0, 1e-12);
  EXPECT_NEAR(rank_sum_test(Values{1, 2}, Values{1, 2})->p, 1.0, 1e-12);
  // 0 0 0 1: only one of 4 choices of one value is as far from the mean as 1.
  EXPECT_NEAR(rank_sum_test(Values{1}, Values{0, 0, 0})->p, 0.25, 1e-12);
}

TEST(RankSum, IsInvariantToGroupOrderAndMonotoneMaps) {
  Random random(3);
  for (int round = 0; round < 40; ++round) {
    Values a, b, exp_a, exp_b;
    for (int n = 0; n < 3; ++n) a.push_back(std::floor(random.uniform(0.0, 8.0)));
    for (int n = 0; n < 9; ++n) b.push_back(std::floor(random.uniform(0.0, 8.0)));
    for (const double value : a) exp_a.push_back(std::exp(value));
    for (const double value : b) exp_b.push_back(std::exp(value));
    const auto test = rank_sum_test(a, b);
    EXPECT_NEAR(rank_sum_test(b, a)->p, test->p, 1e-12);
    EXPECT_NEAR(rank_sum_test(b, a)->u, 27.0 - test->u, 1e-12);
    EXPECT_EQ(rank_sum_test(exp_a, exp_b)->p, test->p);
  }
}

TEST(RankSum, ApproximatesTheExactPInLargeGroups) {
  Random random(5);
  for (int round = 0; round < 20; ++round) {
    Values a, b;
    for (int n = 0; n < 22; ++n) a.push_back(random.normal() + 0.5);
    for (int n = 0; n < 28; ++n) b.push_back(random.normal());
    EXPECT_NEAR(rank_sum_test(a, b, 0)->p, rank_sum_test(a, b)->p, 0.005);
  }
}

TEST(RankSum, FindsNoDifferenceInEqualValues) {
  EXPECT_EQ(rank_sum_test(Values(3, 7.0), Values(5, 7.0))->p, 1.0);
  EXPECT_EQ(rank_sum_test(Values(3, 7.0), Values(5, 7.0), 0)->p, 1.0);
}

TEST(RankSum, CompleteSeparationGivesTheSmallestP) {
  for (const auto& [n1, n2] : {std::pair{2u, 12u}, std::pair{1u, 12u}, std::pair{5u, 7u}}) {
    Values a, b;
    for (unsigned n = 0; n < n1; ++n) a.push_back(100.0 + n);
    for (unsigned n = 0; n < n2; ++n) b.push_back(n);
    EXPECT_NEAR(rank_sum_test(a, b)->p, smallest_rank_sum_p(n1, n2), 1e-12);
  }
  EXPECT_NEAR(smallest_rank_sum_p(2, 12), 2.0 / 91.0, 1e-15);
  EXPECT_EQ(smallest_rank_sum_p(1, 1), 1.0);
}

TEST(RankSum, RefusesNonFiniteValuesAndEmptyGroups) {
  EXPECT_FALSE(rank_sum_test({}, Values{1.0}));
  EXPECT_FALSE(rank_sum_test(Values{1.0}, {}));
  EXPECT_FALSE(rank_sum_test(Values{1.0}, Values{2.0, std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_FALSE(rank_sum_test(Values{std::numeric_limits<double>::infinity()}, Values{2.0}));
}

TEST(Separation, AreaIsTheShareOfPairs) {
  const auto separation = separation_of(kAtTerm, kEarly, Better::kHigher);
  ASSERT_TRUE(separation);
  EXPECT_DOUBLE_EQ(separation->auc, 35.0 / 50.0);
  EXPECT_DOUBLE_EQ(separation->expert_median, 1.415);
  EXPECT_DOUBLE_EQ(separation->novice_median, 0.90);
  EXPECT_EQ(separation->experts, 10u);
  EXPECT_DOUBLE_EQ(separation_of(kAtTerm, kEarly, Better::kLower)->auc, 15.0 / 50.0);
  EXPECT_DOUBLE_EQ(separation_of(kEarly, kAtTerm, Better::kHigher)->auc, 15.0 / 50.0);
  EXPECT_DOUBLE_EQ(separation_of(Values{1.0, 2.0}, Values{2.0}, Better::kHigher)->auc, 0.25) << "a tie counts half";
  EXPECT_DOUBLE_EQ(separation_of(Values{5.0}, Values{5.0}, Better::kLower)->auc, 0.5);
}

TEST(Separation, AreaMatchesTheoryForNormalGroups) {
  // Means one standard deviation apart: Phi(1 / sqrt 2) = 0.7602; the standard error of 500 + 500 people is 0.015.
  Random random(11);
  Values experts, novices;
  for (int n = 0; n < 500; ++n) {
    experts.push_back(1.0 + random.normal());
    novices.push_back(random.normal());
  }
  EXPECT_NEAR(separation_of(experts, novices, Better::kHigher)->auc, 0.7602, 0.045);
}

TEST(AucInterval, LimitsMatchHanleyAndMcNeilsVariance) {
  // Newcombe's variance is Hanley and McNeil's for groups of one size.
  const auto standard_error = [](double area, double n) {
    const double q1 = area / (2.0 - area), q2 = 2.0 * area * area / (1.0 + area);
    return std::sqrt((area * (1.0 - area) + (n - 1.0) * (q1 + q2 - 2.0 * area * area)) / (n * n));
  };
  for (const unsigned n : {2u, 5u, 20u, 200u}) {
    for (const double auc : {0.1, 0.5, 0.8, 0.97}) {
      const Interval interval = auc_interval(auc, n, n);
      EXPECT_NEAR(auc - interval.low, 1.959964 * standard_error(interval.low, n), 1e-6) << n << " " << auc;
      EXPECT_NEAR(interval.high - auc, 1.959964 * standard_error(interval.high, n), 1e-6) << n << " " << auc;
      const Interval mirrored = auc_interval(1.0 - auc, n, n);
      EXPECT_NEAR(mirrored.low, 1.0 - interval.high, 1e-9);
    }
  }
}

TEST(AucInterval, HasALowerLimitForCompleteSeparation) {
  EXPECT_EQ(auc_interval(1.0, 2, 12).high, 1.0);
  EXPECT_EQ(auc_interval(0.0, 2, 12).low, 0.0);
  EXPECT_LT(auc_interval(1.0, 2, 12).low, auc_interval(1.0, 20, 120).low);
  EXPECT_GT(auc_interval(1.0, 200, 1200).low, 0.98);
}

TEST(AucInterval, CoversTheTrueAreaOfSmallGroups) {
  // 2 experts, 12 novices, normal, a distance of 1.5: true area Phi(1.5 / sqrt 2) = 0.8556. 3 standard errors: 0.015.
  constexpr int kStudies = 2000;
  int covered = 0;
  for (int study = 0; study < kStudies; ++study) {
    Random random(static_cast<std::uint64_t>(study) + 77);
    Values experts, novices;
    for (int n = 0; n < 2; ++n) experts.push_back(1.5 + random.normal());
    for (int n = 0; n < 12; ++n) novices.push_back(random.normal());
    const Interval interval = separation_of(experts, novices, Better::kHigher)->auc_interval;
    if (interval.low <= 0.8556 && interval.high >= 0.8556) ++covered;
  }
  EXPECT_NEAR(static_cast<double>(covered) / kStudies, 0.95, 0.03);
}

TEST(CorrectedP, MatchesAManualHolmAndBenjaminiHochberg) {
  const Values p{0.03, 0.01, 0.5, 0.02};  // sorted 0.01 0.02 0.03 0.5
  const auto near = [](const Values& a, const Values& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t n = 0; n < a.size(); ++n) EXPECT_NEAR(a[n], b[n], 1e-12) << n;
  };
  near(corrected_p(p, Correction::kHolm), {0.06, 0.04, 0.5, 0.06});
  near(corrected_p(p, Correction::kBenjaminiHochberg), {0.04, 0.04, 0.5, 0.04});
  near(corrected_p(p, Correction::kNone), p);
  near(corrected_p(Values{0.6, 0.9}, Correction::kHolm), {1.0, 1.0});
  near(corrected_p(Values{0.6, 0.9}, Correction::kBenjaminiHochberg), {0.9, 0.9});
  EXPECT_TRUE(corrected_p({}, Correction::kHolm).empty());
}

TEST(CorrectedP, ControlsTheFamilyWiseErrorRate) {
  // 20 metrics that differ in nothing: 64 % of studies would find one without a correction, at most 5 % with it.
  constexpr int kStudies = 1000;
  int none = 0, holm = 0, benjamini_hochberg = 0;
  for (int study = 0; study < kStudies; ++study) {
    Random random(static_cast<std::uint64_t>(study) + 1);
    Values p;
    for (int n = 0; n < 20; ++n) p.push_back(random.uniform());
    const auto finds = [&](Correction correction) {
      const Values corrected = corrected_p(p, correction);
      return *std::min_element(corrected.begin(), corrected.end()) <= 0.05 ? 1 : 0;
    };
    none += finds(Correction::kNone);
    holm += finds(Correction::kHolm);
    benjamini_hochberg += finds(Correction::kBenjaminiHochberg);
  }
  EXPECT_NEAR(none, 642, 46);  // 1 - 0.95^20, 3 standard errors
  EXPECT_NEAR(holm, 50, 21);
  EXPECT_NEAR(benjamini_hochberg, 50, 21);
}

}  // namespace
}  // namespace trocar::cohort
