#include "xray/physics/beam.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "core/random.h"
#include "xray/physics/materials.h"

namespace trocar::xray {
namespace {

Beam tube_beam() {
  return *Beam::make(*tube_spectrum({.kv = 80.0}));
}

double log_signal(const Beam& beam, std::array<double, kBases> masses) {
  return -std::log(beam.signal(masses));
}

TEST(Beam, FollowsBeersLawForOneEnergy) {
  const Beam beam = *Beam::make(*one_energy(60.0));
  double exponent = 0.0;
  const std::array<double, kBases> masses{12.0, 3.0, 0.05, 0.4};
  for (std::size_t m = 0; m < kBases; ++m)
    exponent += masses[m] * attenuation_cm2_per_g(composition_of(static_cast<Basis>(m)), 60.0);
  EXPECT_NEAR(log_signal(beam, masses), exponent, 1e-12);
  EXPECT_DOUBLE_EQ(beam.signal({}), 1.0);
  EXPECT_DOUBLE_EQ(beam.noise_factor(), 1.0);
}

TEST(Beam, HardensInWater) {
  const Beam beam = tube_beam();
  double before = log_signal(beam, {1.0, 0.0, 0.0, 0.0});
  // Each further centimetre attenuates less, and never less than the hardest photons (80 keV) are.
  for (double water = 2.0; water <= 40.0; water += 1.0) {
    const double step = log_signal(beam, {water, 0, 0, 0}) - log_signal(beam, {water - 1.0, 0, 0, 0});
    EXPECT_LT(step, before);
    EXPECT_GT(step, attenuation_cm2_per_g(composition_of(Basis::kWater), 80.0));
    before = step;
  }
  EXPECT_LT(log_signal(beam, {40.0, 0, 0, 0}) / 40.0, 0.92 * log_signal(beam, {1.0, 0, 0, 0}));
  EXPECT_NEAR(beam.signal({}), 1.0, 1e-6);
}

TEST(Beam, PenetratesWaterOf300Mm) {
  // 60 keV: exp(-0.2059 * 30) = 2.1e-3, not a hundred times more.
  EXPECT_NEAR(Beam::make(*one_energy(60.0))->signal({30.0, 0, 0, 0}), std::exp(-0.2059 * 30.0), 0.01 * 2.1e-3);
}

TEST(Beam, ImagesMatchSinglePixels) {
  const Beam beam = tube_beam();
  MassImage masses{.columns = 67, .rows = 31, .g_per_cm2 = {}};  // no multiple of a vector
  Random random(7);
  for (auto& image : masses.g_per_cm2) image.resize(masses.size());
  for (std::size_t n = 0; n < masses.size(); ++n) {
    masses.of(Basis::kWater)[n] = static_cast<float>(random.uniform(0.0, 45.0));
    masses.of(Basis::kBone)[n] = static_cast<float>(random.uniform(0.0, 8.0));
    if (n > 1000) masses.of(Basis::kIodine)[n] = static_cast<float>(random.uniform(0.0, 0.3));
    if (n > 1500) masses.of(Basis::kSteel)[n] = static_cast<float>(random.uniform(0.0, 2.0));
  }
  std::vector<float> signal(masses.size()), again(masses.size());
  beam.signals(masses, signal);
  for (std::size_t n = 0; n < masses.size(); ++n) {
    std::array<double, kBases> one{};
    for (std::size_t m = 0; m < kBases; ++m) one[m] = static_cast<double>(masses.g_per_cm2[m][n]);
    // Floats: an exponent of 20 has an error of 1e-6 of it.
    ASSERT_NEAR(std::log(static_cast<double>(signal[n])), std::log(beam.signal(one)), 1e-4) << n;
  }
  run_on_threads(1, [&] { beam.signals(masses, again); });
  EXPECT_EQ(signal, again);
}

TEST(Beam, TreatsAnEmptyImageAsNoAttenuation) {
  MassImage masses{.columns = 5, .rows = 3, .g_per_cm2 = {}};
  std::vector<float> signal(15, 0.0F);
  tube_beam().signals(masses, signal);
  for (const float s : signal) EXPECT_NEAR(s, 1.0F, 1e-5F);
}

TEST(Beam, CountsMostPhotonsInAThickDetector) {
  const Tube tube{.kv = 80.0};
  const Spectrum spectrum = *tube_spectrum(tube);
  const Beam beam = *Beam::make(spectrum), thin = *Beam::make(spectrum, 0.1);
  double photons = 0.0;
  for (const double n : spectrum.photons) photons += n;
  EXPECT_LT(beam.detected_photons(), photons);
  EXPECT_GT(beam.detected_photons(), 0.6 * photons);  // 0.6 mm of CsI absorb most photons at 80 kV
  EXPECT_LT(thin.detected_photons(), 0.5 * beam.detected_photons());
  EXPECT_GT(beam.noise_factor(), 1.0);
  EXPECT_LT(beam.noise_factor(), 1.15);
}

TEST(Beam, RefusesADetectorOutOfRangeAndAnEmptySpectrum) {
  EXPECT_FALSE(Beam::make(*one_energy(60.0), 0.0));
  EXPECT_FALSE(Beam::make(*one_energy(60.0), std::nan("")));
  EXPECT_FALSE(Beam::make(Spectrum{}));
}

}  // namespace
}  // namespace trocar::xray
