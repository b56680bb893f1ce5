#include "cohort/validity.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/random.h"

namespace trocar::cohort {
namespace {

/// Two experts and twelve novices; the score, one metric that separates them and one that does not.
CohortData study(bool is_simulated) {
  CohortData data;
  Random random(9);
  MetricOfPeople error{"error", "Error", "mm", Better::kLower}, shoe{"shoe", "Shoe size", "1", Better::kNeither};
  for (int n = 0; n < 14; ++n) {
    const bool is_expert = n < 2;
    const double skill = is_expert ? 95.0 + n : 40.0 + 2.0 * n;
    data.people.push_back({is_expert, is_simulated});
    data.scores.emplace_back(skill);
    error.values.emplace_back(100.0 - skill);
    shoe.values.emplace_back(36.0 + (n * 5) % 9);
    data.items.push_back({0.5 * skill + random.normal(), 0.3 * skill + random.normal(), 0.2 * skill});
  }
  data.metrics = {error, shoe};
  return data;
}

TEST(Validity, FindsTheMetricThatSeparates) {
  const Validity validity = validity_of(study(true));
  EXPECT_EQ(validity.experts, 2u);
  EXPECT_EQ(validity.novices, 12u);
  EXPECT_EQ(validity.simulated, 14u);
  EXPECT_EQ(validity.tested, 2u);
  EXPECT_EQ(validity.discriminating, 1u);
  ASSERT_TRUE(validity.metrics[0].separation);
  EXPECT_EQ(validity.metrics[0].separation->auc, 1.0);
  EXPECT_TRUE(validity.metrics[0].discriminates);
  EXPECT_NEAR(validity.metrics[0].corrected_p, 2.0 * 2.0 / 91.0, 1e-12);
  EXPECT_FALSE(validity.metrics[1].discriminates);
  EXPECT_TRUE(validity.score.discriminates);
  ASSERT_TRUE(validity.alpha);
  EXPECT_GT(validity.alpha->value, 0.8);
  ASSERT_TRUE(validity.pass_mark);
  EXPECT_GT(validity.pass_mark->value, 66.0);
  EXPECT_EQ(validity.pass_mark->false_passes, 0u);
  EXPECT_EQ(validity_of(study(false)).simulated, 0u);
}

TEST(Validity, WorseExpertsGiveNoEvidence) {
  CohortData data = study(true);
  data.metrics[0].better = Better::kHigher;
  const Validity validity = validity_of(data);
  EXPECT_EQ(validity.metrics[0].separation->auc, 0.0);
  EXPECT_LT(validity.metrics[0].corrected_p, 0.05);
  EXPECT_FALSE(validity.metrics[0].discriminates);
}

TEST(Validity, HolmRejectsTwoExpertsAndThreeMetrics) {
  CohortData data = study(true);
  data.metrics.push_back(data.metrics[0]);
  const Validity holm = validity_of(data, {0.05, Correction::kHolm});
  EXPECT_EQ(holm.discriminating, 0u);
  EXPECT_EQ(holm.uncorrected, 2u);
  EXPECT_EQ(validity_of(data, {0.05, Correction::kNone}).discriminating, 2u);
  EXPECT_EQ(validity_of(data).discriminating, 2u);
  EXPECT_EQ(smallest_p_text(2, 12, 3, 0.05),
            "with groups of 2 and 12 people whose values all differ no two-sided p can be below 0.022");
  EXPECT_EQ(smallest_p_text(8, 12, 3, 0.05), "");
  EXPECT_EQ(smallest_p_text(0, 12, 3, 0.05), "");
}

TEST(Validity, SkipsMissingValues) {
  CohortData data = study(true);
  data.metrics[0].values[5].reset();
  data.metrics[1].values[0].reset();
  data.metrics[1].values[1] = std::numeric_limits<double>::quiet_NaN();
  data.items[3][1].reset();
  data.scores[4].reset();
  const Validity validity = validity_of(data);
  EXPECT_EQ(validity.metrics[0].separation->novices, 11u);
  ASSERT_FALSE(validity.metrics[1].separation);
  EXPECT_NE(validity.metrics[1].separation.error().text().find("people with a value: experts 0, novices 12"),
            std::string::npos);
  EXPECT_EQ(validity.tested, 1u);
  EXPECT_EQ(validity.alpha->people, 14u);
  EXPECT_EQ(validity.alpha->items, 2u) << "one person lacks the second of three";
  EXPECT_EQ(validity.pass_mark->novices.people, 11u);
}

TEST(Validity, GivesReasonsForAnEmptyGroup) {
  const Validity validity = validity_of({});
  EXPECT_EQ(validity.experts + validity.novices + validity.tested, 0u);
  EXPECT_FALSE(validity.score.separation);
  EXPECT_FALSE(validity.alpha);
  EXPECT_FALSE(validity.pass_mark);
}

}  // namespace
}  // namespace trocar::cohort
