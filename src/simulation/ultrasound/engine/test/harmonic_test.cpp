// Tissue harmonic imaging against closed forms and against the fundamental image of the same scene.
#include <numbers>

#include "ultrasound/engine/beam.h"
#include "ultrasound/engine/detail/clutter.h"
#include "ultrasound/test/physics_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

constexpr double kReceived_mhz = 4.0, kTransmitted_mhz = 2.0;
constexpr double kFocus_mm = 60.0;  // the transmitting and the receiving aperture have the same f-number there

/// The convex array with the same focus in both planes.
Transducer array() {
  Transducer transducer = convex();
  transducer.elevation_focus_mm = kFocus_mm;
  return transducer;
}

Acquisition imaging(bool is_harmonic, double frequency_mhz, const Artefacts& artefacts = no_artefacts()) {
  Acquisition acquisition = plain(array(), artefacts);
  acquisition.depth_mm = 120.0;
  acquisition.focus_mm = kFocus_mm;
  acquisition.frequency_mhz = frequency_mhz;
  acquisition.is_harmonic = is_harmonic;
  return acquisition;
}

TEST(HarmonicBeam, WidthLiesBetweenTransmitAndSameFrequencyBeams) {
  const Beam harmonic = make_harmonic_beam(array(), kReceived_mhz, kFocus_mm);
  const Beam transmitted = make_beam(array(), kTransmitted_mhz, kFocus_mm);
  const Beam same = make_beam(array(), kReceived_mhz, kFocus_mm);
  // Widths of two Gaussians, w/sqrt(2) and w/2 one-way, against w and w, or w/2 and w/2.
  for (const auto sigma : {&Beam::lateral_sigma_mm, &Beam::elevation_sigma_mm}) {
    EXPECT_NEAR((harmonic.*sigma)(kFocus_mm) / (transmitted.*sigma)(kFocus_mm), 1.0 / std::sqrt(3.0), 1e-6);
    EXPECT_NEAR((harmonic.*sigma)(kFocus_mm) / (same.*sigma)(kFocus_mm), 2.0 / std::sqrt(3.0), 1e-6);
  }
  EXPECT_NEAR(harmonic.axial_sigma_mm / transmitted.axial_sigma_mm, 1.0 / std::numbers::sqrt2, 1e-9);
}

TEST(HarmonicShare, OfAPlaneWaveGrowsLinearly) {
  Beam plane_wave = make_harmonic_beam(array(), kReceived_mhz, kFocus_mm);
  // Focused at its Rayleigh distance, where it is as wide as at the face.
  plane_wave.focus_mm = plane_wave.elevation_focus_mm = 1e7;
  const double sigma_mm = std::sqrt(2.0 * plane_wave.wavelength_mm * plane_wave.focus_mm / (2.0 * std::numbers::pi));
  plane_wave.aperture_mm = plane_wave.elevation_aperture_mm = sigma_mm / 0.2991;
  plane_wave.f_number = 1e-3;
  // beta omega p z / (2 rho c^3) with 4.4, 2 pi 2 MHz, 1.2 MPa, 50 mm, 1060 kg/m3, 1540 m/s.
  EXPECT_NEAR(harmonic_share(plane_wave, 50.0), 0.428, 0.002);
  EXPECT_NEAR(harmonic_share(plane_wave, 25.0), 0.214, 0.002);
}

TEST(HarmonicShare, GrowsWithDepthFastestAtTheFocus) {
  const Beam beam = make_harmonic_beam(array(), kReceived_mhz, kFocus_mm);
  EXPECT_EQ(harmonic_share(beam, 0.0), 0.0);
  double before = 0.0, fastest = 0.0, at_mm = 0.0;
  for (double depth_mm = 5.0; depth_mm <= 150.0; depth_mm += 5.0) {
    const double share = harmonic_share(beam, depth_mm);
    EXPECT_GT(share, before) << depth_mm;
    if (share - before > fastest) {
      fastest = share - before;
      at_mm = depth_mm;
    }
    before = share;
  }
  EXPECT_NEAR(at_mm, kFocus_mm, 10.0);
  EXPECT_LT(before, 1.0);
  EXPECT_EQ(harmonic_share(make_beam(array(), kReceived_mhz, kFocus_mm), 10.0), 1.0) << "a fundamental";
}

TEST(HarmonicFrequency, IsTwiceABandFrequencyOrNone) {
  Transducer transducer = convex();  // 2 to 5 MHz
  EXPECT_EQ(harmonic_mhz(transducer, 3.5), 4.0);
  EXPECT_EQ(harmonic_mhz(transducer, 4.6), 4.6);
  EXPECT_EQ(harmonic_mhz(transducer, 9.0), 5.0);
  transducer.lowest_mhz = 3.0;
  EXPECT_FALSE(harmonic_mhz(transducer, 4.0));
  // Without an octave the image is the fundamental one.
  const ScenePtr scene = homogeneous_scene(box_for(transducer, 60.0, 1.0), TestTissue::kLossless);
  Acquisition with = plain(transducer), without = plain(transducer);
  with.is_harmonic = true;
  BMode harmonic(scene, transducer, with), fundamental(scene, transducer, without);
  EXPECT_EQ(harmonic.render({}).re, fundamental.render({}).re);
}

/// Width at half of the peak, mm, of a point at the focus.
double point_width_mm(bool is_harmonic, double frequency_mhz) {
  const ScenePtr scene = points_scene(box_for(array(), 120.0, 0.5), TestTissue::kWater, {{{0.0, kFocus_mm, 0.0}, 1.0}});
  Acquisition acquisition = imaging(is_harmonic, frequency_mhz);
  acquisition.lines = 1024;
  acquisition.steering_angles = 1;
  BMode engine(scene, array(), acquisition);
  const BasebandFrame& frame = engine.render({});
  const EchoPatch patch = patch_at(frame, 0.0, 15.0, kFocus_mm - 2.0, kFocus_mm + 2.0);
  const Peak peak = peak_of(patch);
  std::vector<double> across;
  for (int line = 0; line < patch.lines; ++line) across.push_back(patch.at(line, peak.sample));
  return full_width(across) * frame.geometry.line_spacing_mm(kFocus_mm);
}

TEST(HarmonicImage, PointIsThinnerThanAtTheTransmitFrequency) {
  const double ratio = point_width_mm(true, kReceived_mhz) / point_width_mm(false, kTransmitted_mhz);
  EXPECT_NEAR(ratio, 1.0 / std::sqrt(3.0), 0.03);
}

/// Level of a cyst of 8 mm radius at the focus relative to the tissue beside it, dB.
double harmonic_cyst_db(bool is_harmonic) {
  const TestRod cyst{0.0, kFocus_mm, 8.0, TestTissue::kWater};
  Artefacts artefacts = no_artefacts();
  artefacts.clutter = true;
  BMode engine(rods_scene(box_for(array(), 120.0, 0.5), TestTissue::kLossless, {&cyst, 1}), array(),
               imaging(is_harmonic, kReceived_mhz, artefacts));
  const BasebandFrame& frame = engine.render({});
  return level_db(patch_at(frame, 0.0, 3.0, 57.0, 63.0)) - level_db(patch_at(frame, 25.0, 5.0, 54.0, 66.0));
}

TEST(HarmonicImage, HasLessClutterInACyst) {
  const double fundamental_db = harmonic_cyst_db(false);
  EXPECT_GT(fundamental_db, detail::kClutter_db);
  EXPECT_NEAR(harmonic_cyst_db(true), 1.5 * fundamental_db, 1.5) << "its transmitted half counts twice";
}

/// Level in shallow fluid behind 25 mm of tissue, relative to the tissue, as the scanner shows it, dB.
double haze_db(bool is_harmonic) {
  const TestLayer layers[] = {{25.0, TestTissue::kLossless}, {120.0, TestTissue::kWater}};
  Artefacts artefacts = no_artefacts();
  artefacts.clutter = true;
  BMode engine(layers_scene(box_for(array(), 120.0, 0.5), layers), array(),
               imaging(is_harmonic, kReceived_mhz, artefacts));
  const BasebandFrame& frame = engine.render({});
  const auto shown_db = [&](double depth_mm) {
    return level_db(patch_at(frame, 0.0, 15.0, depth_mm - 2.0, depth_mm + 2.0)) -
           20.0 * std::log10(harmonic_share(frame.beam, depth_mm));
  };
  return shown_db(31.0) - shown_db(17.0);
}

TEST(HarmonicImage, HasLessHazeInTheNearField) {
  EXPECT_LT(haze_db(true), haze_db(false) - 6.0);
}

/// Level of speckle at a depth, dB.
double level_at_db(const BasebandFrame& frame, double depth_mm) {
  return level_db(patch_at(frame, 0.0, 15.0, depth_mm - 4.0, depth_mm + 4.0));
}

TEST(HarmonicImage, AttenuatesMoreAndBuildsUpInTissue) {
  Artefacts artefacts = no_artefacts();
  artefacts.attenuation = true;
  const ScenePtr scene = homogeneous_scene(box_for(array(), 120.0, 2.0), TestTissue::kTissue);
  BMode harmonic(scene, array(), imaging(true, kReceived_mhz, artefacts));
  BMode fundamental(scene, array(), imaging(false, kTransmitted_mhz, artefacts));
  const BasebandFrame &h = harmonic.render({}), &f = fundamental.render({});
  const double fall_h = level_at_db(h, 110.0) - level_at_db(h, 40.0);
  const double fall_f = level_at_db(f, 110.0) - level_at_db(f, 40.0);
  const Beam beam = make_harmonic_beam(array(), kReceived_mhz, kFocus_mm);
  const double gained_db = 20.0 * std::log10(harmonic_share(beam, 110.0) / harmonic_share(beam, 40.0));
  // 0.5 dB/cm/MHz, 2 MHz more, there and back over 70 mm; the shadowless scatter of two speckle patterns.
  EXPECT_NEAR(fall_h - fall_f, gained_db - 14.0, 1.5);
}

TEST(HarmonicLevels, FollowTheShareAndAreCompensatedByGain) {
  const Beam beam = make_harmonic_beam(array(), kReceived_mhz, kFocus_mm);
  const ScanGeometry geometry = make_scan_geometry(array(), 120.0, 128, 512);
  const std::vector<float> levels = harmonic_levels(beam, geometry);
  ASSERT_EQ(levels.size(), 512U);
  for (const std::size_t s : {20U, 100U, 300U, 500U}) {
    const double depth_mm = (static_cast<double>(s) + 0.5) * geometry.sample_mm();
    EXPECT_NEAR(levels[s], harmonic_share(beam, depth_mm) / harmonic_share(beam, kFocus_mm), 0.01);
    EXPECT_NEAR(harmonic_gain_db(levels[s]) + 20.0 * std::log10(levels[s]), 0.0, s == 20 ? 20.0 : 1e-4);
  }
  EXPECT_EQ(harmonic_gain_db(0.0F), kMostHarmonicGain_db);
}

}  // namespace
}  // namespace trocar::ultrasound
