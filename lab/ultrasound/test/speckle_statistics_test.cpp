#include "lab/ultrasound/speckle_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"

namespace trocar::ultrasound {
namespace {

constexpr double kFwhmOfGaussian = 2.3548200450309493;

EchoPatch smoothed(const EchoPatch& source, double sigma, bool is_axial) {
  if (sigma <= 0.0) return source;
  EchoPatch result = source;
  const int reach = static_cast<int>(4.0 * sigma) + 1;
  const int length = is_axial ? source.samples : source.lines;
  for (int line = 0; line < source.lines; ++line)
    for (int sample = 0; sample < source.samples; ++sample) {
      double sum = 0.0;
      for (int k = -reach; k <= reach; ++k) {
        const int place = ((is_axial ? sample : line) + k + length) % length;
        const float value = is_axial ? source.at(line, place) : source.at(place, sample);
        sum += std::exp(-0.5 * k * k / (sigma * sigma)) * value;
      }
      result.at(line, sample) = static_cast<float>(sum);
    }
  return result;
}

/// Envelope of a circular Gaussian field smoothed by Gaussians of those widths (steps); sigma 0 leaves it white.
EchoPatch gaussian_field(int lines, int samples, double sigma_lines, double sigma_samples, std::uint64_t seed) {
  Random random(seed);
  EchoPatch parts[2];
  for (EchoPatch& part : parts) {
    part.lines = lines;
    part.samples = samples;
    part.values.resize(static_cast<std::size_t>(lines) * static_cast<std::size_t>(samples));
    for (float& value : part.values) value = static_cast<float>(random.normal());
    part = smoothed(smoothed(part, sigma_samples, true), sigma_lines, false);
  }
  for (std::size_t i = 0; i < parts[0].values.size(); ++i)
    parts[0].values[i] = std::hypot(parts[0].values[i], parts[1].values[i]);
  return parts[0];
}

/// Envelope of a K distribution with a whole `alpha`: the local power is a mean of `alpha` exponentials.
std::vector<float> k_distributed(std::size_t count, int alpha, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> values(count);
  for (float& value : values) {
    double power = 0.0;
    for (int i = 0; i < alpha; ++i) power -= std::log(1.0 - random.uniform()) / alpha;
    value = static_cast<float>(std::sqrt(power) * std::hypot(random.normal(), random.normal()));
  }
  return values;
}

TEST(SpeckleMoments, MatchRayleighForACircularGaussianField) {
  const SpeckleMoments moments = speckle_moments(gaussian_field(200, 500, 0.0, 0.0, 1).values);
  // Standard errors with 100,000 independent values: snr 0.005, m 0.006; four of them.
  EXPECT_NEAR(moments.snr, kRayleighSnr, 0.02);
  EXPECT_NEAR(moments.nakagami_m, 1.0, 0.025);
  EXPECT_NEAR(moments.nakagami_m_ml, 1.0, 0.015);
  EXPECT_NEAR(moments.mean_intensity, 2.0, 0.03);
  EXPECT_NEAR(moments.mean, std::sqrt(std::numbers::pi / 2.0), 0.01);
}

TEST(SpeckleMoments, FollowTheShapeOfAKDistribution) {
  for (const int alpha : {1, 4, 16}) {
    const SpeckleMoments moments = speckle_moments(k_distributed(400000, alpha, 2));
    // Normalised variance of a K-distributed intensity is 1 + 2/alpha (Jakeman & Pusey 1976); Nakagami's is 1/m.
    const double expected = 1.0 / (1.0 + 2.0 / alpha);
    EXPECT_NEAR(moments.nakagami_m, expected, 0.05 * expected) << alpha;
    EXPECT_LT(moments.snr, kRayleighSnr - 0.2 / alpha) << alpha;
  }
}

TEST(SpeckleMoments, RecoverTheNakagamiParameter) {
  Random random(3);
  std::vector<float> values(200000);
  for (float& value : values) {  // m = 3: the sum of three exponentials.
    double intensity = 0.0;
    for (int i = 0; i < 3; ++i) intensity -= std::log(1.0 - random.uniform());
    value = static_cast<float>(std::sqrt(intensity));
  }
  EXPECT_NEAR(speckle_moments(values).nakagami_m, 3.0, 0.06);
  EXPECT_NEAR(speckle_moments(values).nakagami_m_ml, 3.0, 0.04);
}

TEST(SpeckleMoments, AreFiniteForEmptyAndConstantInput) {
  EXPECT_EQ(speckle_moments({}).snr, 0.0);
  EXPECT_EQ(speckle_moments(std::vector<float>(10, 2.0F)).snr, 0.0);
}

TEST(RayleighFit, RejectsRayleighAtTheTabulatedRate) {
  int refused = 0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    const EchoPatch field = gaussian_field(20, 50, 0.0, 0.0, 100 + static_cast<std::uint64_t>(trial));
    if (fit_rayleigh(field.values).statistic > kRayleighStatistic95) ++refused;
  }
  // 5 % of 400 with four binomial standard deviations (4.4).
  EXPECT_NEAR(refused, 20, 18);
}

TEST(RayleighFit, RefusesKDistributionsAndRiceans) {
  EXPECT_GT(fit_rayleigh(k_distributed(5000, 4, 5)).statistic, 3.0);
  std::vector<float> ricean(5000);
  Random random(7);
  for (float& value : ricean) value = static_cast<float>(std::hypot(random.normal() + 1.5, random.normal()));
  EXPECT_GT(fit_rayleigh(ricean).statistic, 3.0);
}

TEST(SpeckleCorrelation, FindsTheWidthsOfTheSmoothingKernel) {
  EchoPatch envelope = gaussian_field(240, 400, 3.0, 2.0, 8);
  envelope.line_mm = 0.5;
  envelope.sample_mm = 0.15;
  const SpeckleCorrelation correlation = speckle_correlation(intensity_of(envelope));
  // About 2,500 cells: 4 % is three standard errors.
  EXPECT_NEAR(correlation.axial_fwhm_mm, kFwhmOfGaussian * 2.0 * 0.15, 0.04 * 0.706);
  EXPECT_NEAR(correlation.lateral_fwhm_mm, kFwhmOfGaussian * 3.0 * 0.5, 0.04 * 3.53);
  const double cell = std::sqrt(2.0 * std::numbers::pi);  // Integral of the intensity's autocovariance, in sigmas.
  const double cells = 240.0 * 400.0 / (3.0 * cell * 2.0 * cell);
  EXPECT_NEAR(correlation.cells, cells, 0.15 * cells);
}

TEST(SpeckleCorrelation, OfTheEnvelopeMatchesThatOfTheIntensity) {
  const EchoPatch envelope = gaussian_field(160, 300, 3.0, 2.0, 9);
  const SpeckleCorrelation of_envelope = speckle_correlation(envelope);
  const SpeckleCorrelation of_intensity = speckle_correlation(intensity_of(envelope));
  EXPECT_NEAR(of_envelope.axial_fwhm_mm / of_intensity.axial_fwhm_mm, 1.0, 0.05);
  EXPECT_NEAR(of_envelope.lateral_fwhm_mm / of_intensity.lateral_fwhm_mm, 1.0, 0.05);
}

TEST(SpeckleCorrelation, YieldsIndependentThinnedValues) {
  const EchoPatch envelope = gaussian_field(240, 600, 3.0, 2.0, 10);
  const SpeckleCorrelation correlation = speckle_correlation(intensity_of(envelope));
  const std::vector<float> values = thinned(envelope, correlation);
  EXPECT_GT(values.size(), 800u);
  EXPECT_LT(fit_rayleigh(values).statistic, kRayleighStatistic99);
}

TEST(WithoutTrend, RemovesASlopeAndKeepsTheSpeckle) {
  EchoPatch patch = gaussian_field(120, 200, 2.0, 2.0, 11);
  const SpeckleCorrelation before = speckle_correlation(patch);
  const double mean = speckle_moments(patch.values).mean;
  for (int line = 0; line < patch.lines; ++line)
    for (int sample = 0; sample < patch.samples; ++sample)
      patch.at(line, sample) += static_cast<float>(mean * (0.05 * line + 0.02 * sample));
  EXPECT_FALSE(speckle_correlation(patch).axial_fwhm_mm < 3.0 * before.axial_fwhm_mm);
  const SpeckleCorrelation after = speckle_correlation(without_trend(patch));
  EXPECT_NEAR(after.axial_fwhm_mm, before.axial_fwhm_mm, 0.05 * before.axial_fwhm_mm);
  EXPECT_NEAR(after.lateral_fwhm_mm, before.lateral_fwhm_mm, 0.05 * before.lateral_fwhm_mm);
}

TEST(LevelAgainstDepth, FindsTheSlopeOfAnExponentialLoss) {
  EchoPatch patch = gaussian_field(200, 800, 0.0, 0.0, 12);
  patch.sample_mm = 0.2;
  patch.depth_mm = 10.0;
  constexpr double kLoss_db_per_mm = 0.35;
  for (int line = 0; line < patch.lines; ++line)
    for (int sample = 0; sample < patch.samples; ++sample)
      patch.at(line, sample) *= static_cast<float>(std::pow(10.0, -kLoss_db_per_mm * 0.2 * sample / 20.0));
  const auto levels = level_against_depth(patch, 5.0);
  ASSERT_EQ(levels.size(), 32u);
  EXPECT_NEAR(levels.front().depth_mm, 10.0 + 12.0 * 0.2, 1e-9);
  EXPECT_NEAR(level_slope_db_per_mm(levels), -kLoss_db_per_mm, 0.005);
}

TEST(NormalisedCorrelation, IsOneForScaledAndZeroForUnrelatedFields) {
  const EchoPatch a = gaussian_field(60, 60, 0.0, 0.0, 13);
  std::vector<float> scaled = a.values;
  for (float& value : scaled) value = 3.0F * value + 1.0F;
  EXPECT_NEAR(normalised_correlation(a.values, scaled), 1.0, 1e-6);
  EXPECT_NEAR(normalised_correlation(a.values, gaussian_field(60, 60, 0.0, 0.0, 14).values), 0.0, 0.07);
}

}  // namespace
}  // namespace trocar::ultrasound
