#include "ultrasound/engine/beam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "core/files/folders.h"

namespace trocar::ultrasound {
namespace {

constexpr double kFwhmOfBeam = 2.3548;  // of a Gaussian, in standard deviations

Transducer example_transducer() {
  Transducer t;
  t.frequency_mhz = 3.0;
  t.bandwidth = 0.5;
  t.pitch_mm = 0.4;
  t.active_elements = 64;
  t.f_number = 3.0;
  t.elevation_aperture_mm = 13.0;
  t.elevation_focus_mm = 65.0;
  return t;
}

/// Pressure of a uniform, focused aperture off its axis: Fresnel's integral, summed up.
double field(double x_mm, double depth_mm, double aperture_mm, double focus_mm, double wavelength_mm) {
  constexpr int kPoints = 400;
  const double k = 2.0 * std::numbers::pi / wavelength_mm;
  std::complex<double> sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double u = aperture_mm * ((i + 0.5) / kPoints - 0.5);
    sum += std::polar(1.0, k * ((x_mm - u) * (x_mm - u) / (2.0 * depth_mm) - u * u / (2.0 * focus_mm)));
  }
  return std::abs(sum);
}

/// Full width of an even, falling profile where it is half of its middle.
template <class Profile>
double width_mm(const Profile& profile) {
  constexpr double kStep_mm = 0.005;
  double x_mm = 0.0;
  while (profile(x_mm) > 0.5 * profile(0.0)) x_mm += kStep_mm;
  return 2.0 * x_mm;
}

TEST(Beam, PulseHasTheTransducersBandwidth) {
  const Transducer t = example_transducer();
  const Beam beam = make_beam(t, t.frequency_mhz, 60.0);
  // The envelope's spectrum at half the bandwidth from the centre, by the sum itself.
  const double off_mhz = 0.5 * t.bandwidth * t.frequency_mhz;
  double spectrum = 0.0, middle = 0.0;
  for (double z_mm = -10.0; z_mm <= 10.0; z_mm += 0.001) {
    const double envelope = std::exp(-0.5 * std::pow(z_mm / beam.axial_sigma_mm, 2));
    spectrum += envelope * std::cos(2.0 * std::numbers::pi * off_mhz * 2.0 * z_mm / kScannerSpeed_mm_per_us);
    middle += envelope;
  }
  EXPECT_NEAR(spectrum / middle, 0.5, 1e-6);
}

TEST(Beam, LateralWidthAtTheFocusMatchesTheExactAperture) {
  const Transducer t = example_transducer();
  const Beam beam = make_beam(t, 3.0, 60.0);
  const double exact_mm = width_mm(
      [&](double x_mm) { return std::pow(field(x_mm, 60.0, 60.0 / t.f_number, 60.0, beam.wavelength_mm), 2); });
  EXPECT_NEAR(kFwhmOfBeam * beam.lateral_sigma_mm(60.0), exact_mm, 0.01 * exact_mm);
  EXPECT_NEAR(exact_mm, 0.8859 * beam.wavelength_mm * t.f_number, 0.01);
}

TEST(Beam, LateralWidthOffTheFocusFollowsFresnel) {
  const Transducer t = example_transducer();
  const Beam beam = make_beam(t, 3.0, 60.0);
  const double transmit_mm = 60.0 / t.f_number;
  for (const double depth_mm : {30.0, 45.0, 55.0, 70.0, 85.0, 110.0, 140.0}) {
    const double receive_mm = std::min(depth_mm / t.f_number, t.aperture_mm());
    const double exact_mm = width_mm([&](double x_mm) {
      return field(x_mm, depth_mm, transmit_mm, 60.0, beam.wavelength_mm) *
             field(x_mm, depth_mm, receive_mm, depth_mm, beam.wavelength_mm);
    });
    // Uniform apertures have Fresnel ripples that no Gaussian has.
    EXPECT_NEAR(kFwhmOfBeam * beam.lateral_sigma_mm(depth_mm), exact_mm, 0.15 * exact_mm) << depth_mm;
  }
}

TEST(Beam, SliceIsThinnestNearTheLensFocus) {
  const Beam beam = make_beam(example_transducer(), 3.0, 80.0);
  double best_mm = 1e9, at_mm = 0.0;
  for (double depth_mm = 1.0; depth_mm < 200.0; depth_mm += 1.0) {
    if (beam.elevation_sigma_mm(depth_mm) >= best_mm) continue;
    best_mm = beam.elevation_sigma_mm(depth_mm);
    at_mm = depth_mm;
  }
  // Diffraction draws the waist a little towards the face.
  EXPECT_LT(at_mm, 65.0);
  EXPECT_GT(at_mm, 45.0);
  const double exact_mm =
      width_mm([&](double z_mm) { return std::pow(field(z_mm, 65.0, 13.0, 65.0, beam.wavelength_mm), 2); });
  EXPECT_NEAR(kFwhmOfBeam * beam.elevation_sigma_mm(65.0), exact_mm, 0.01 * exact_mm);
  EXPECT_GT(beam.elevation_sigma_mm(0.0), 2.0 * best_mm);
  EXPECT_GT(beam.elevation_sigma_mm(160.0), 2.0 * best_mm);
}

TEST(Beam, WidthsArePositiveAndContinuous) {
  const auto transducers = load_transducers(data_dir() / "transducers.toml");
  ASSERT_TRUE(transducers) << transducers.error().text();
  for (const Transducer& t : *transducers) {
    const Beam beam = make_beam(t, t.frequency_mhz, t.focus_mm);
    EXPECT_GT(beam.axial_sigma_mm, 0.02);
    EXPECT_LT(beam.axial_sigma_mm, 1.0);
    for (double depth_mm = 0.0; depth_mm < t.greatest_depth_mm; depth_mm += 0.5) {
      const double lateral_mm = beam.lateral_sigma_mm(depth_mm);
      const double elevation_mm = beam.elevation_sigma_mm(depth_mm);
      EXPECT_GT(lateral_mm, 0.05) << t.name << " " << depth_mm;
      EXPECT_LT(lateral_mm, 10.0) << t.name << " " << depth_mm;
      EXPECT_GT(elevation_mm, 0.05) << t.name << " " << depth_mm;
      EXPECT_LT(elevation_mm, 15.0) << t.name << " " << depth_mm;
      // A beam spreads by less than an angle of 0.2 rad: half a millimetre changes it by less than 0.1 mm.
      EXPECT_LT(std::abs(beam.lateral_sigma_mm(depth_mm + 0.5) - lateral_mm), 0.1) << t.name << " " << depth_mm;
      EXPECT_LT(std::abs(beam.elevation_sigma_mm(depth_mm + 0.5) - elevation_mm), 0.1) << t.name << " " << depth_mm;
    }
  }
}

TEST(Beam, HigherFrequencyIsFinerInEveryDirection) {
  const Beam low = make_beam(example_transducer(), 2.0, 70.0);
  const Beam high = make_beam(example_transducer(), 5.0, 70.0);
  EXPECT_NEAR(low.axial_sigma_mm / high.axial_sigma_mm, 2.5, 1e-12);
  EXPECT_NEAR(low.lateral_sigma_mm(70.0) / high.lateral_sigma_mm(70.0), 2.5, 1e-12);
  EXPECT_NEAR(low.elevation_sigma_mm(65.0) / high.elevation_sigma_mm(65.0), 2.5, 1e-12);
}

}  // namespace
}  // namespace trocar::ultrasound
