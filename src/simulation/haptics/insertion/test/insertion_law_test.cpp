#include "haptics/insertion/insertion_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace trocar::haptics {
namespace {

// Paper A, Table 1.
constexpr LoadingLaw kSkin{0.46, 0.02, 0.1};
constexpr LoadingLaw kMuscle{0.19, 0.03, 0.11};
constexpr LoadingLaw kLiver{0.42, 0.02, 0.12};

TEST(PrepunctureForce, EqualsTheSumOfVoigtElements) {
  // Paper A: it starts with one Voigt element, and one is added whenever x exceeds a multiple of dx. Element i is i
  // times as stiff as the first and stretched by x - (i - 1) dx; every element has the same damper. At x = n dx the
  // printed cubic is the sum over these n elements.
  for (const LoadingLaw& law : {kSkin, kMuscle, kLiver}) {
    for (int n = 1; n <= 20; ++n) {
      const double x = n * law.delta_x_mm;
      for (const double v : {0.0, 2.0, 50.0}) {
        double sum_n = 0.0;
        for (int i = 1; i <= n; ++i)
          sum_n += i * law.stiffness_n_per_mm * (x - (i - 1) * law.delta_x_mm) + law.viscosity_ns_per_mm * v;
        EXPECT_NEAR(prepuncture_force_n(x, v, law), sum_n, 1e-12 * (1.0 + sum_n)) << n << " elements";
      }
    }
  }
}

TEST(PrepunctureForce, MatchesTheDisplacementsOfTable1) {
  constexpr double kTwoDigits = 0.005;  // references.md prints two digits
  EXPECT_NEAR(static_displacement_mm(2.8, kSkin), 0.62, kTwoDigits);
  EXPECT_NEAR(static_displacement_mm(2.5, kMuscle), 0.88, kTwoDigits);
  EXPECT_NEAR(static_displacement_mm(1.5, kLiver), 0.56, kTwoDigits);
  constexpr double kOneDigit = 0.06;
  EXPECT_NEAR(tangent_stiffness_n_per_mm(static_displacement_mm(2.8, kSkin), kSkin), 11.8, kOneDigit);
  EXPECT_NEAR(tangent_stiffness_n_per_mm(static_displacement_mm(2.5, kMuscle), kMuscle), 7.7, kOneDigit);
  EXPECT_NEAR(tangent_stiffness_n_per_mm(static_displacement_mm(1.5, kLiver), kLiver), 6.7, kOneDigit);
}

TEST(PrepunctureForce, IsNonNegativeAndZeroOutside) {
  EXPECT_EQ(prepuncture_force_n(0.0, 10.0, kSkin), 0.0);
  EXPECT_EQ(prepuncture_force_n(-1.0, 10.0, kSkin), 0.0);
  for (double v = -200.0; v < 0.0; v += 10.0) EXPECT_GE(prepuncture_force_n(0.3, v, kSkin), 0.0);
  EXPECT_EQ(prepuncture_force_n(0.3, -200.0, kSkin), 0.0);
}

TEST(TangentStiffness, IsTheDerivativeOfTheForce) {
  for (const double x : {0.1, 0.5, 0.9}) {
    constexpr double kStep = 1e-6;
    const double slope =
        (prepuncture_force_n(x + kStep, 0, kMuscle) - prepuncture_force_n(x - kStep, 0, kMuscle)) / (2 * kStep);
    EXPECT_NEAR(tangent_stiffness_n_per_mm(x, kMuscle), slope, 1e-6);
  }
}

TEST(ContactArea, IsTheCylinderInSquareCentimetres) {
  // The example of docs/physics.md F1: a 1.2 mm needle 30 mm deep, at 10 mm/s and nu = 0.02: 0.23 N, not 22 N.
  const double area = contact_area_cm2(0.6, 30.0);
  EXPECT_NEAR(area, 2 * std::numbers::pi * 0.6 * 30.0 / 100.0, 1e-12);
  EXPECT_NEAR(0.02 * 10.0 * area, 0.226, 0.001);
  EXPECT_EQ(contact_area_cm2(0.6, -1.0), 0.0);
}

TEST(FrictionNoise, IsUniformAtItsNodesAndBounded) {
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kNodes = 20000;
  for (int i = 0; i < kNodes; ++i) {
    const double value = friction_noise(7, 3, i * kNoiseCorrelation_mm);
    ASSERT_LE(std::abs(value), 1.0);
    sum += value;
    squares += value * value;
  }
  constexpr double kThreeSigma = 3.0 * 0.577 / 141.0;  // of the mean of 20,000 uniform numbers
  EXPECT_NEAR(sum / kNodes, 0.0, kThreeSigma);
  EXPECT_NEAR(squares / kNodes, 1.0 / 3.0, 0.01);  // variance of the uniform distribution on [-1, 1]
}

TEST(FrictionNoise, DependsOnSeedAndTissueAndIsContinuous) {
  EXPECT_NE(friction_noise(1, 3, 5.0), friction_noise(2, 3, 5.0));
  EXPECT_NE(friction_noise(1, 3, 5.0), friction_noise(1, 4, 5.0));
  for (double s = -3.0; s < 3.0; s += 0.001)
    ASSERT_NEAR(friction_noise(1, 3, s), friction_noise(1, 3, s + 0.001),
                2.0 * 1.5 * 0.001 / kNoiseCorrelation_mm + 1e-12);
}

TEST(MotionFade, IsZeroAtRestAndOneInMotion) {
  EXPECT_EQ(motion_fade(0.0), 0.0);
  EXPECT_EQ(motion_fade(-0.25), 0.5);
  EXPECT_EQ(motion_fade(3.0), 1.0);
}

}  // namespace
}  // namespace trocar::haptics
