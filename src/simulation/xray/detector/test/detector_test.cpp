#include "xray/detector/detector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/parallel.h"
#include "xray/detector/scatter.h"

namespace trocar::xray {
namespace {

constexpr int kDetectorPixels = 256;
constexpr std::size_t kDetectorCount = static_cast<std::size_t>(kDetectorPixels) * kDetectorPixels;

double mean_of(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double variance_of(const std::vector<float>& values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const float value : values) sum += (value - mean) * (value - mean);
  return sum / static_cast<double>(values.size() - 1);
}

/// Relative standard error of a variance of kDetectorCount normal numbers is sqrt(2 / kDetectorCount) = 0.55 %.
constexpr double kVarianceTolerance = 0.03;

TEST(QuantumNoise, HasPhotonVarianceAndKeepsTheMean) {
  for (const double open : {400.0, 1600.0, 25600.0})
    for (const double level : {1.0, 0.2}) {
      std::vector<float> image(kDetectorCount, static_cast<float>(level));
      add_quantum_noise({open, 1.1}, 7, image);
      const double expected = 1.1 * level / open;
      EXPECT_NEAR(variance_of(image), expected, kVarianceTolerance * expected) << open << " " << level;
      EXPECT_NEAR(mean_of(image), level, 4.0 * std::sqrt(expected / static_cast<double>(kDetectorCount)));
    }
}

TEST(QuantumNoise, IsNormal) {
  std::vector<float> image(kDetectorCount, 1.0F);
  add_quantum_noise({1e4, 1.0}, 3, image);
  for (const double sigmas : {-2.5, -1.0, 0.0, 0.5, 2.0}) {
    const auto below = std::count_if(image.begin(), image.end(), [&](float v) { return v < 1.0 + sigmas * 0.01; });
    const double expected = 0.5 * std::erfc(-sigmas / std::sqrt(2.0));
    EXPECT_NEAR(static_cast<double>(below) / static_cast<double>(kDetectorCount), expected, 0.008) << sigmas;
  }
  double fourth = 0.0;
  for (const float value : image) fourth += std::pow((value - 1.0) / 0.01, 4.0);
  EXPECT_NEAR(fourth / static_cast<double>(kDetectorCount), 3.0, 0.1);
}

TEST(QuantumNoise, IsIndependentBetweenPixelsAndSeeds) {
  std::vector<float> a(kDetectorCount, 1.0F), b(kDetectorCount, 1.0F);
  add_quantum_noise({1e4, 1.0}, 3, a);
  add_quantum_noise({1e4, 1.0}, 4, b);
  double next = 0.0, other = 0.0;
  for (std::size_t n = 0; n + 1 < kDetectorCount; ++n) {
    next += (a[n] - 1.0) * (a[n + 1] - 1.0);
    other += (a[n] - 1.0) * (b[n] - 1.0);
  }
  const double standard_error = 1e-4 * std::sqrt(static_cast<double>(kDetectorCount));
  EXPECT_LT(std::abs(next), 4.0 * standard_error);
  EXPECT_LT(std::abs(other), 4.0 * standard_error);
}

TEST(QuantumNoise, IsTheSameOnAnyNumberOfThreads) {
  std::vector<float> one(kDetectorCount + 1, 0.5F), many(kDetectorCount + 1, 0.5F);
  run_on_threads(1, [&] { add_quantum_noise({500.0, 1.0}, 9, one); });
  run_on_threads(4, [&] { add_quantum_noise({500.0, 1.0}, 9, many); });
  EXPECT_EQ(one, many);
}

TEST(QuantumNoise, KeepsZeroSignalAtZero) {
  std::vector<float> image(100, 0.0F);
  add_quantum_noise({500.0, 1.0}, 9, image);
  EXPECT_EQ(*std::max_element(image.begin(), image.end()), 0.0F);
}

/// Modulation of a sine of `cycles` per pixel after the blur.
double transfer(double sigma_px, double cycles) {
  std::vector<float> image(kDetectorCount);
  for (int row = 0; row < kDetectorPixels; ++row)
    for (int column = 0; column < kDetectorPixels; ++column)
      image[static_cast<std::size_t>(row * kDetectorPixels + column)] =
          static_cast<float>(1.0 + std::cos(2.0 * std::numbers::pi * cycles * column));
  blur_image(image, kDetectorPixels, kDetectorPixels, sigma_px);
  double sum = 0.0;
  int count = 0;
  for (int column = 64; column < 192; ++column, ++count)
    sum += (image[static_cast<std::size_t>(128 * kDetectorPixels + column)] - 1.0) *
           std::cos(2.0 * std::numbers::pi * cycles * column);
  return 2.0 * sum / count;
}

TEST(ImageBlur, HasTheTransferOfAGaussian) {
  for (const double sigma : {0.25, 0.5, 0.69, 1.0, 2.3})
    for (const double cycles : {1.0 / 32.0, 1.0 / 16.0, 1.0 / 8.0}) {
      const double exponent = std::numbers::pi * sigma * cycles;
      EXPECT_NEAR(transfer(sigma, cycles), std::exp(-2.0 * exponent * exponent), 0.012) << sigma << " " << cycles;
    }
}

TEST(ImageBlur, HasHalfTheModulationAtTheDetectorsFrequency) {
  DetectorParams params;
  const double pixel_mm = 1.0 / (8.0 * params.mtf_half_lp_per_mm);
  EXPECT_NEAR(transfer(scintillator_sigma_mm(params) / pixel_mm, 1.0 / 8.0), 0.5, 0.01);
}

TEST(ImageBlur, KeepsUniformImagesAndTheMean) {
  for (const double sigma : {0.5, 3.0}) {
    std::vector<float> image(kDetectorCount, 0.7F);
    blur_image(image, kDetectorPixels, kDetectorPixels, sigma);
    for (const float value : image) ASSERT_NEAR(value, 0.7, 1e-5);
    image.assign(kDetectorCount, 0.0F);
    image[100 * kDetectorPixels + 90] = 1.0F;
    blur_image(image, kDetectorPixels, kDetectorPixels, sigma);
    EXPECT_NEAR(mean_of(image) * static_cast<double>(kDetectorCount), 1.0, 1e-4);
  }
}

TEST(FocalSpot, HasNoShadowBlurAtTheDetector) {
  CArm arm;
  arm.source_detector_mm = 1000.0;
  arm.source_isocentre_mm = 500.0;
  DetectorParams params;
  params.focal_spot_mm = 1.2;
  EXPECT_NEAR(focal_spot_sigma_mm(params, arm), 1.2 / std::sqrt(12.0), 1e-12);
  arm.source_isocentre_mm = 999.999;
  EXPECT_NEAR(focal_spot_sigma_mm(params, arm), 0.0, 1e-5);
}

TEST(Lag, DecaysByTheSameShareEachFrame) {
  Lag lag;
  std::vector<float> image(4, 1.0F);
  lag.apply(0.2, 0.0, image);
  EXPECT_FLOAT_EQ(image[0], 1.0F);
  double expected = 1.0;
  for (int n = 0; n < 4; ++n) {
    image.assign(4, 0.0F);
    lag.apply(0.2, 1.0 / 30.0, image);
    expected *= 0.2;
    EXPECT_NEAR(image[2], expected, 1e-6);
  }
  image.assign(4, 0.0F);
  lag.apply(0.2, 2.0 / 30.0, image);
  EXPECT_NEAR(image[2], expected * 0.04, 1e-7);
}

TEST(Lag, KeepsAConstantSignalAndRestartsAtAnotherSize) {
  Lag lag;
  std::vector<float> image(4, 0.3F);
  for (int n = 0; n < 5; ++n) lag.apply(0.1, 1.0 / 15.0, image);
  EXPECT_FLOAT_EQ(image[3], 0.3F);
  std::vector<float> other(9, 2.0F);
  lag.apply(0.1, 1.0 / 15.0, other);
  EXPECT_FLOAT_EQ(other[8], 2.0F);
}

/// An even patient of `mass` g/cm² with primary 0.02 in the middle `share` of the field.
struct Even {
  CArm arm;
  MassImage patient;
  std::vector<float> primary;

  explicit Even(double mass, double share = 1.0) {
    arm.pixels = kDetectorPixels;
    arm.field_mm = 600.0;
    patient.columns = patient.rows = kDetectorPixels;
    patient.of(Basis::kWater).assign(kDetectorCount, static_cast<float>(mass));
    primary.assign(kDetectorCount, 0.0F);
    const int margin = static_cast<int>(std::lround(0.5 * (1.0 - share) * kDetectorPixels));
    for (int row = margin; row < kDetectorPixels - margin; ++row)
      for (int column = margin; column < kDetectorPixels - margin; ++column)
        primary[static_cast<std::size_t>(row * kDetectorPixels + column)] = 0.02F;
  }
  double middle(const DetectorParams& params) const {
    std::vector<float> signal(kDetectorCount, 0.0F);
    add_scatter(estimate_scatter(patient, primary, arm, params), kDetectorPixels, kDetectorPixels, signal);
    return signal[kDetectorPixels / 2 * kDetectorPixels + kDetectorPixels / 2];
  }
};

TEST(Scatter, HasTheWideFieldRatioBehindTheGrid) {
  const DetectorParams params;
  const double expected = 0.02 * 0.15 * 20.0 * 0.15 / 0.70;
  EXPECT_NEAR(Even(20.0).middle(params), expected, 0.01 * expected);
  EXPECT_NEAR(Even(10.0).middle(params), 0.5 * expected, 0.01 * expected);
  EXPECT_EQ(Even(0.0).middle(params), 0.0);
}

TEST(Scatter, ScalesWithTheGaussianWithinTheField) {
  const DetectorParams params;
  for (const double share : {0.1, 0.2, 0.4}) {
    const double inside = std::erf(0.5 * share * 600.0 / params.scatter_spread_mm / std::sqrt(2.0));
    EXPECT_NEAR(Even(20.0, share).middle(params) / Even(20.0).middle(params), inside * inside, 0.04) << share;
  }
}

TEST(Scatter, IsSmoothAndHalvedAtTheEdge) {
  const DetectorParams params;
  const Even even(20.0);
  std::vector<float> signal(kDetectorCount, 0.0F);
  add_scatter(estimate_scatter(even.patient, even.primary, even.arm, params), kDetectorPixels, kDetectorPixels, signal);
  const double middle = signal[kDetectorPixels / 2 * kDetectorPixels + kDetectorPixels / 2];
  EXPECT_NEAR(signal[kDetectorPixels / 2 * kDetectorPixels] / middle, 0.5, 0.06);
  for (int column = 1; column < kDetectorPixels; ++column)
    EXPECT_LT(std::abs(signal[static_cast<std::size_t>(kDetectorPixels / 2 * kDetectorPixels + column)] -
                       signal[static_cast<std::size_t>(kDetectorPixels / 2 * kDetectorPixels + column - 1)]),
              0.04 * middle);
}

}  // namespace
}  // namespace trocar::xray
