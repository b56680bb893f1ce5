#include "cohort/detail/distributions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace trocar::cohort {
namespace {

TEST(Normal, MatchesTabulatedQuantiles) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_NEAR(normal_quantile(0.5), 0.0, 1e-12);
  EXPECT_NEAR(normal_quantile(0.025), -normal_quantile(0.975), 1e-12);
  EXPECT_NEAR(normal_below(-1.0), 0.158655253931457, 1e-14);
}

TEST(IncompleteBeta, MatchesClosedForms) {
  for (double x = 0.0; x <= 1.0; x += 0.0625) {
    EXPECT_NEAR(incomplete_beta(1.0, 1.0, x), x, 1e-13);
    EXPECT_NEAR(incomplete_beta(3.0, 1.0, x), x * x * x, 1e-13);
    EXPECT_NEAR(incomplete_beta(1.0, 4.0, x), 1.0 - std::pow(1.0 - x, 4.0), 1e-13);
    EXPECT_NEAR(incomplete_beta(0.5, 0.5, x), 2.0 / std::numbers::pi * std::asin(std::sqrt(x)), 1e-12);
    EXPECT_NEAR(incomplete_beta(2.5, 7.0, x) + incomplete_beta(7.0, 2.5, 1.0 - x), 1.0, 1e-13);
  }
}

TEST(FQuantile, MatchesTabulatedAndClosedValues) {
  EXPECT_NEAR(f_quantile(0.95, 1.0, 11.0), 2.200985 * 2.200985, 1e-4);  // Student's t of 11 degrees of freedom
  EXPECT_NEAR(f_quantile(0.95, 5.0, 10.0), 3.3258, 1e-4);               // tables of the F distribution
  EXPECT_NEAR(f_quantile(0.5, 7.0, 7.0), 1.0, 1e-10);
  EXPECT_NEAR(f_quantile(0.9, 2.0, 2.0), 9.0, 1e-9);  // P(F < f) = f / (1 + f)
  EXPECT_NEAR(f_quantile(0.05, 4.0, 9.0) * f_quantile(0.95, 9.0, 4.0), 1.0, 1e-10);
}

}  // namespace
}  // namespace trocar::cohort
