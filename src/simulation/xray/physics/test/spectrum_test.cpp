#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "xray/physics/beam.h"
#include "xray/physics/materials.h"

namespace trocar::xray {
namespace {

Spectrum spectrum_of(double kv, double aluminium_mm, double copper_mm = 0.0) {
  return *tube_spectrum({.kv = kv, .aluminium_mm = aluminium_mm, .copper_mm = copper_mm});
}

double mean_kev(const Spectrum& spectrum) {
  const double photons = std::accumulate(spectrum.photons.begin(), spectrum.photons.end(), 0.0);
  return std::inner_product(spectrum.photons.begin(), spectrum.photons.end(), spectrum.energy_kev.begin(), 0.0) /
         photons;
}

TEST(TubeSpectrum, MatchesMeasuredHalfValueLayers) {
  // PTB's tube (doi 10.7795/110.20190315B): 2.5 mm of aluminium, then more behind it. Its anode of 20 degrees and the
  // 12 degrees here differ by up to 3 % of the half-value layer.
  struct Quality {
    double kv, aluminium_mm, half_value_layer_mm;
  };
  for (const Quality q :
       {Quality{50, 2.5, 1.72}, Quality{70, 2.5, 2.29}, Quality{80, 2.5, 2.59}, Quality{100, 2.5, 3.23},
        Quality{120, 2.5, 3.88}, Quality{150, 2.5, 5.01}, Quality{60, 18.5, 5.24}})
    EXPECT_NEAR(half_value_layer_mm(spectrum_of(q.kv, q.aluminium_mm)) / q.half_value_layer_mm, 1.0, 0.04) << q.kv;
}

TEST(TubeSpectrum, MatchesStandardQualitiesWithAUsualFilter) {
  // IEC 61267, RQR 5, 6, 8, 9: a laboratory adjusts the filter until the half-value layer is this.
  struct Quality {
    double kv, half_value_layer_mm;
  };
  for (const Quality q : {Quality{70, 2.58}, Quality{80, 3.01}, Quality{100, 3.97}, Quality{120, 5.00}}) {
    EXPECT_LT(half_value_layer_mm(spectrum_of(q.kv, 2.5)), q.half_value_layer_mm) << q.kv;
    EXPECT_GT(half_value_layer_mm(spectrum_of(q.kv, 4.0)), q.half_value_layer_mm) << q.kv;
  }
}

TEST(TubeSpectrum, MatchesTheFluenceOfStandardQualities) {
  // IEC 62220-1, table 2: photons per mm² and µGy of RQA 5, 7, 9, which have these half-value layers.
  struct Quality {
    double kv, half_value_layer_mm, photons;
  };
  for (const Quality q : {Quality{70, 6.8, 30174}, Quality{90, 9.2, 32362}, Quality{120, 11.6, 31077}}) {
    double low = 10.0, high = 60.0;  // behind the tube's range: aluminium in front of a spectrum
    Spectrum filtered;
    for (int n = 0; n < 30; ++n) {
      const double middle = 0.5 * (low + high);
      filtered = spectrum_of(q.kv, 2.5);
      for (std::size_t k = 0; k < filtered.photons.size(); ++k)
        filtered.photons[k] *=
            std::exp(-0.1 * middle * kAluminium_g_per_cm3 * attenuation_cm2_per_g(aluminium(), filtered.energy_kev[k]));
      (half_value_layer_mm(filtered) < q.half_value_layer_mm ? low : high) = middle;
    }
    const double photons = std::accumulate(filtered.photons.begin(), filtered.photons.end(), 0.0);
    EXPECT_NEAR(photons / (1e3 * air_kerma_mgy(filtered)) / q.photons, 1.0, 0.03) << q.kv;
  }
}

TEST(TubeSpectrum, MatchesTheOutputOfATube) {
  // Measured tubes with 2.5 to 3 mm of aluminium at 1 m and 80 kV: 0.06 to 0.1 mGy/mAs. About the square of the
  // voltage.
  const double at_80 = air_kerma_mgy(spectrum_of(80.0, 2.5));
  EXPECT_GT(at_80, 0.06);
  EXPECT_LT(at_80, 0.1);
  const double exponent = std::log(air_kerma_mgy(spectrum_of(120.0, 2.5)) / at_80) / std::log(120.0 / 80.0);
  EXPECT_GT(exponent, 1.5);
  EXPECT_LT(exponent, 2.5);
}

TEST(TubeSpectrum, EndsAtTheTubeVoltageWithKLinesAboveTheEdge) {
  const Spectrum low = spectrum_of(69.0, 2.5), high = spectrum_of(100.0, 2.5);
  EXPECT_LT(low.energy_kev.back(), 69.0);
  EXPECT_LT(high.energy_kev.back(), 100.0);
  const auto step_at_line = [](const Spectrum& s) {  // bins of 1 keV from 10
    return s.photons[49] / s.photons[47 - 1];        // 59..60 keV over 56..57 keV
  };
  EXPECT_LT(step_at_line(low), 1.0);
  EXPECT_GT(step_at_line(high), 1.5);
}

TEST(TubeSpectrum, HardensByFilters) {
  const double soft = mean_kev(spectrum_of(80.0, 2.5)), copper = mean_kev(spectrum_of(80.0, 2.5, 0.2));
  EXPECT_NEAR(soft, 43.0, 2.0);  // mean energies of published spectra at 80 kV
  EXPECT_GT(copper, soft + 4.0);
  EXPECT_LT(air_kerma_mgy(spectrum_of(80.0, 2.5, 0.2)), 0.6 * air_kerma_mgy(spectrum_of(80.0, 2.5)));
}

TEST(OneEnergy, HalfValueLayerMatchesItsAttenuation) {
  const double expected = std::numbers::ln2 / (0.1 * kAluminium_g_per_cm3 * attenuation_cm2_per_g(aluminium(), 60.0));
  EXPECT_NEAR(half_value_layer_mm(*one_energy(60.0)), expected, 1e-6 * expected);
}

TEST(TubeSpectrum, RefusesImpossibleTubes) {
  for (const Tube& tube : {Tube{.kv = 20.0}, Tube{.kv = 400.0}, Tube{.kv = std::nan("")}, Tube{.aluminium_mm = 0.0},
                           Tube{.copper_mm = -0.1}}) {
    const auto spectrum = tube_spectrum(tube);
    ASSERT_FALSE(spectrum);
    EXPECT_EQ(spectrum.error().exit_status, 2);
    EXPECT_NE(spectrum.error().advice.find("from"), std::string::npos);
  }
  EXPECT_FALSE(one_energy(5.0));
}

}  // namespace
}  // namespace trocar::xray
