#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cohort/validity.h"
#include "core/random.h"

namespace trocar::cohort {
namespace {

using Rows = std::vector<std::vector<double>>;

/// Each item is the person's skill (standard deviation 1) and independent noise.
Rows parallel_items(std::size_t people, std::size_t items, double noise, std::uint64_t seed) {
  Random random(seed);
  Rows rows;
  for (std::size_t n = 0; n < people; ++n) {
    const double skill = random.normal();
    rows.emplace_back();
    for (std::size_t item = 0; item < items; ++item) rows.back().push_back(skill + noise * random.normal());
  }
  return rows;
}

TEST(CronbachAlpha, MatchesAManualCalculation) {
  // Variances of the items 0.7, 0.8, 0.7, of the totals 10 9 13 8 12: 4.3. 3/2 (1 - 2.2 / 4.3) = 0.7326.
  const auto alpha = cronbach_alpha(Rows{{3, 4, 3}, {2, 3, 4}, {4, 4, 5}, {3, 2, 3}, {4, 4, 4}});
  ASSERT_TRUE(alpha);
  EXPECT_NEAR(alpha->value, 1.5 * (1.0 - 2.2 / 4.3), 1e-12);
  EXPECT_EQ(alpha->items, 3u);
  EXPECT_EQ(alpha->people, 5u);
}

TEST(CronbachAlpha, MatchesSpearmanBrownForParallelItems) {
  // Reliability of an item 1 / (1 + noise²) = 0.5; of k items k / (k + 1). 4000 people: standard error about 0.01.
  for (const std::size_t items : {2u, 4u, 10u}) {
    const double k = static_cast<double>(items);
    EXPECT_NEAR(cronbach_alpha(parallel_items(4000, items, 1.0, items))->value, k / (k + 1.0), 0.03) << items;
  }
}

TEST(CronbachAlpha, ReachesItsLimits) {
  EXPECT_NEAR(cronbach_alpha(parallel_items(20, 4, 0.0, 1))->value, 1.0, 1e-12);
  const auto unrelated = cronbach_alpha(parallel_items(4000, 4, 1e6, 2));
  EXPECT_NEAR(unrelated->value, 0.0, 0.08);
  // Opposite items: variances 4/3 and 7/3, totals 1 2 3 with variance 1.
  EXPECT_NEAR(cronbach_alpha(Rows{{1, 0}, {3, -1}, {1, 2}})->value, 2.0 * (1.0 - (4.0 / 3.0 + 7.0 / 3.0) / 1.0), 1e-12);
}

TEST(CronbachAlpha, IsInvariantToUnitOriginAndOrder) {
  const Rows rows = parallel_items(12, 5, 0.8, 7);
  Rows changed = rows;
  for (std::vector<double>& row : changed) {
    for (double& item : row) item = 10.0 * item - 40.0;
    std::swap(row[0], row[3]);
  }
  std::swap(changed[1], changed[7]);
  EXPECT_NEAR(cronbach_alpha(changed)->value, cronbach_alpha(rows)->value, 1e-10);
}

/// A table with the given alpha: noise that leaves the totals as they are, scaled until it has it.
Rows rows_with_alpha(double wanted, std::size_t people, std::size_t items) {
  Rows low = parallel_items(people, items, 0.05, 3);
  double least = 0.0, most = 100.0;
  const Rows noise = parallel_items(people, items, 1.0, 4);
  for (int n = 0; n < 200; ++n) {
    const double share = 0.5 * (least + most);
    Rows rows = low;
    for (std::size_t i = 0; i < people; ++i)
      for (std::size_t j = 0; j < items; ++j) rows[i][j] += share * (noise[i][j] - noise[i][(j + 1) % items]);
    (cronbach_alpha(rows)->value > wanted ? least : most) = share;
    if (n == 199) return rows;
  }
  return {};
}

TEST(FeldtInterval, MatchesPublishedLimits) {
  const auto check = [](double alpha, std::size_t people, std::size_t items, double low, double high) {
    const auto found = cronbach_alpha(rows_with_alpha(alpha, people, items));
    ASSERT_TRUE(found);
    ASSERT_NEAR(found->value, alpha, 1e-9);
    EXPECT_NEAR(found->interval.low, low, 1e-6);
    EXPECT_NEAR(found->interval.high, high, 1e-6);
  };
  check(0.913, 873, 20, 0.9044024, 0.9211588);      // MRC CBU, Feldt's interval
  check(0.591719, 15, 10, 0.19492169, 0.83982087);  // real-statistics.com, Cronbach's alpha
}

TEST(FeldtInterval, CoversTheTrueAlpha) {
  constexpr int kStudies = 1000;
  int covered = 0;
  for (int study = 0; study < kStudies; ++study) {
    const auto alpha = cronbach_alpha(parallel_items(14, 6, 1.0, static_cast<std::uint64_t>(study) + 100));
    if (alpha->interval.low <= 6.0 / 7.0 && alpha->interval.high >= 6.0 / 7.0) ++covered;
  }
  EXPECT_NEAR(covered, 950, 21) << "3 standard errors";
}

TEST(CronbachAlpha, RefusesWithAReason) {
  const auto reason = [](const Rows& rows) {
    const auto alpha = cronbach_alpha(rows);
    return alpha ? std::string("none") : alpha.error().text();
  };
  EXPECT_NE(reason({}).find("at least 2 people, not 0"), std::string::npos);
  EXPECT_NE(reason({{1, 2}}).find("at least 2 people, not 1"), std::string::npos);
  EXPECT_NE(reason({{1}, {2}}).find("at least 2 items, not 1"), std::string::npos);
  EXPECT_NE(reason({{1, 2}, {1}}).find("person 2 has 1 items"), std::string::npos);
  EXPECT_NE(reason({{1, 2}, {2, 1}}).find("same total"), std::string::npos);
  EXPECT_NE(reason({{0.1, 0.2}, {0.1, 0.2}, {0.1, 0.2}}).find("same total"), std::string::npos);
  EXPECT_NE(reason({{1, 2}, {2, std::numeric_limits<double>::quiet_NaN()}}).find("person 2"), std::string::npos);
}

}  // namespace
}  // namespace trocar::cohort
