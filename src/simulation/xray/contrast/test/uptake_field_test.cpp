#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "xray/contrast/detail/stain_site.h"

namespace trocar::xray::detail {
namespace {

constexpr double kCorrelation_mm = 5.0;
constexpr int kSamples = 200000;

/// Mean of the product of the field at two points `apart` correlation lengths from each other.
double covariance(double apart, std::uint64_t seed) {
  Random random(7);
  double sum = 0.0;
  for (int n = 0; n < kSamples; ++n) {
    const Vec3 p_P(random.uniform(-5000.0, 5000.0), random.uniform(-5000.0, 5000.0), random.uniform(-5000.0, 5000.0));
    sum += uptake_field(p_P, kCorrelation_mm, seed) *
           uptake_field(p_P + Vec3(0.0, apart * kCorrelation_mm, 0.0), kCorrelation_mm, seed);
  }
  return sum / kSamples;
}

TEST(UptakeField, HasTheCorrelationOfItsSpline) {
  // The quintic B-spline at 0, 1, 2 and 3, relative to 66/120: 1, 26/66, 1/66, 0. Five standard errors: 0.012.
  EXPECT_NEAR(covariance(0.0, 1), 1.0, 0.012);
  EXPECT_NEAR(covariance(1.0, 1), 26.0 / 66.0, 0.012);
  EXPECT_NEAR(covariance(2.0, 1), 1.0 / 66.0, 0.012);
  EXPECT_NEAR(covariance(3.0, 1), 0.0, 0.012);
}

TEST(UptakeField, HasMeanZeroAndIsSmooth) {
  Random random(3);
  double sum = 0.0;
  for (int n = 0; n < kSamples; ++n) {
    const Vec3 p_P(random.uniform(-5000.0, 5000.0), random.uniform(-5000.0, 5000.0), random.uniform(-5000.0, 5000.0));
    const double here = uptake_field(p_P, kCorrelation_mm, 1);
    sum += here;
    EXPECT_NEAR(uptake_field(p_P + Vec3(1e-4, 0.0, 0.0), kCorrelation_mm, 1), here, 1e-3);
  }
  EXPECT_NEAR(sum / kSamples, 0.0, 0.012);
}

TEST(UptakeField, DependsOnTheSeedOnly) {
  const Vec3 p_P(12.0, -34.0, 56.0);
  EXPECT_EQ(uptake_field(p_P, kCorrelation_mm, 4), uptake_field(p_P, kCorrelation_mm, 4));
  EXPECT_NE(uptake_field(p_P, kCorrelation_mm, 4), uptake_field(p_P, kCorrelation_mm, 5));
}

}  // namespace
}  // namespace trocar::xray::detail
