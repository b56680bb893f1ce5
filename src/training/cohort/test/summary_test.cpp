#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "cohort/learning_curve.h"

namespace trocar::cohort {
namespace {

TEST(Quantile, InterpolatesBetweenSortedValues) {
  const std::vector<double> values{40.0, 10.0, 30.0, 20.0};  // R: quantile(c(40, 10, 30, 20)) is 10 17.5 25 32.5 40
  const auto quartiles = quartiles_of(values);
  ASSERT_TRUE(quartiles);
  EXPECT_DOUBLE_EQ(quartiles->min, 10.0);
  EXPECT_DOUBLE_EQ(quartiles->q1, 17.5);
  EXPECT_DOUBLE_EQ(quartiles->median, 25.0);
  EXPECT_DOUBLE_EQ(quartiles->q3, 32.5);
  EXPECT_DOUBLE_EQ(quartiles->max, 40.0);
}

TEST(Quantile, HandlesOneValueAndNone) {
  EXPECT_EQ(quantile_of(std::vector{7.0}, 0.3), 7.0);
  EXPECT_FALSE(quantile_of({}, 0.5));
  EXPECT_FALSE(quartiles_of({}));
}

TEST(StandardDeviation, UsesTheSampleFormula) {
  EXPECT_DOUBLE_EQ(standard_deviation_of(std::vector{2.0, 4.0}), std::sqrt(2.0));
}

TEST(PersonMean, AveragesSelectedAttemptsWithValues) {
  const std::vector<std::optional<double>> scores{10.0, std::nullopt, 30.0, std::numeric_limits<double>::quiet_NaN(),
                                                  50.0};
  EXPECT_EQ(person_mean(scores), 30.0);
  EXPECT_EQ(person_mean(scores, {2, 4}), 30.0);  // attempt 2 counts as an attempt
  EXPECT_EQ(person_mean(scores, {3, 5}), 40.0);
  EXPECT_FALSE(person_mean(scores, {2, 2}));
  EXPECT_FALSE(person_mean(scores, {6, 9}));
  EXPECT_FALSE(person_mean({}));
}

TEST(CheckFinite, NamesTheValue) {
  const Status status = check_finite(std::vector{1.0, std::numeric_limits<double>::quiet_NaN()}, "the experts");
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().text().find("value 2 is not a number — the experts"), std::string::npos);
  EXPECT_TRUE(check_finite({}, "nothing"));
}

}  // namespace
}  // namespace trocar::cohort
