// Sound from the whole aperture: soft shadows; and the spectrum that attenuation shifts.

#include "ultrasound/engine/beam.h"
#include "ultrasound/test/physics_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

constexpr double kShadeDepth_mm = 120.0;

Acquisition deep(const Transducer& transducer, const Artefacts& artefacts) {
  Acquisition acquisition = plain(transducer, artefacts);
  acquisition.depth_mm = kShadeDepth_mm;
  return acquisition;
}

/// Level behind an opaque object against the same scatterers without it, dB, along x at one depth.
class Shade {
 public:
  explicit Shade(const ScenePtr& with)
      : with_(with, convex(), deep(convex(), losses())),
        without_(homogeneous_scene(box_for(convex(), kShadeDepth_mm), TestTissue::kLossless), convex(),
                 deep(convex(), losses())),
        a_(with_.render({})),
        b_(without_.render({})) {}

  double at(double x_mm, double y_mm) const {
    constexpr double kHalfWidth_mm = 1.0, kHalfDepth_mm = 4.0;
    const auto level = [&](const BasebandFrame& frame) {
      return level_db(patch_at(frame, x_mm, kHalfWidth_mm, y_mm - kHalfDepth_mm, y_mm + kHalfDepth_mm));
    };
    return level(a_) - level(b_);
  }

 private:
  BMode with_, without_;
  const BasebandFrame &a_, &b_;
};

/// Where the scanline through (x0, y0) is at another depth.
double along_scanline(double x0_mm, double y0_mm, double y_mm) {
  const double radius_mm = convex().radius_mm;
  return x0_mm * (y_mm + radius_mm) / (y0_mm + radius_mm);
}

TEST(Penumbra, AtTheEdgeHalvesTheApertureInBothDirections) {
  constexpr double kEdge_mm = 15.0, kTop_mm = 26.0;
  const Shade shade(slab_scene(box_for(convex(), kShadeDepth_mm), TestTissue::kLossless,
                               {kEdge_mm, kTop_mm, 36.0, TestTissue::kBone}));
  for (const double y_mm : {70.0, 100.0}) {
    const double edge_mm = along_scanline(kEdge_mm, kTop_mm, y_mm);
    // Half of the amplitude in each direction: -12 dB. The slab's voxels of 1 mm, and rays that are not infinitely
    // many.
    EXPECT_NEAR(shade.at(edge_mm, y_mm), -12.04, 3.0) << y_mm;
    EXPECT_LT(shade.at(0.0, y_mm), -40.0) << "in the shadow";
    EXPECT_NEAR(shade.at(edge_mm + 18.0, y_mm), 0.0, 0.3) << "beside it";
    double last_db = -1e3;
    for (double x_mm = edge_mm - 12.0; x_mm <= edge_mm + 12.0; x_mm += 2.0) {
      const double here_db = shade.at(x_mm, y_mm);
      EXPECT_GT(here_db, last_db - 0.5) << x_mm;
      last_db = here_db;
    }
  }
}

TEST(Penumbra, GrowsBehindTheEdge) {
  constexpr double kEdge_mm = 15.0, kTop_mm = 26.0;
  const Shade shade(slab_scene(box_for(convex(), kShadeDepth_mm), TestTissue::kLossless,
                               {kEdge_mm, kTop_mm, 36.0, TestTissue::kBone}));
  // Distance over which the level rises from -20 to -2 dB.
  const auto width_mm = [&](double y_mm) {
    const double edge_mm = along_scanline(kEdge_mm, kTop_mm, y_mm);
    double from_mm = 0.0, to_mm = 0.0;
    for (double x_mm = edge_mm - 15.0; x_mm <= edge_mm + 15.0; x_mm += 0.5) {
      if (shade.at(x_mm, y_mm) < -20.0) from_mm = x_mm;
      if (shade.at(x_mm, y_mm) < -2.0) to_mm = x_mm;
    }
    return to_mm - from_mm;
  };
  const double near_mm = width_mm(50.0), far_mm = width_mm(105.0);
  EXPECT_GT(far_mm, 1.5 * near_mm);
  EXPECT_LT(far_mm, 15.0);
}

TEST(Penumbra, SoundPassesAroundASmallObstacle) {
  const TestRod rods[] = {{0.0, 20.0, 3.0, TestTissue::kBone}};
  const Shade shade(rods_scene(box_for(convex(), kShadeDepth_mm), TestTissue::kLossless, rods));
  EXPECT_LT(shade.at(0.0, 32.0), -25.0);
  EXPECT_GT(shade.at(0.0, 105.0), -30.0);
  EXPECT_GT(shade.at(0.0, 105.0), shade.at(0.0, 60.0) + 3.0);
}

TEST(Penumbra, DoesNotChangeTissueWithoutObstacles) {
  const Shade shade(homogeneous_scene(box_for(convex(), kShadeDepth_mm), TestTissue::kLossless));
  for (const double x_mm : {-40.0, 0.0, 40.0}) EXPECT_NEAR(shade.at(x_mm, 80.0), 0.0, 1e-3);
}

/// Echo of a pulse with a Gaussian spectrum behind a loss of `nepers_per_mhz`, against one at the centre frequency:
/// summed over the spectrum, dB.
double spectral_gain_db(const Beam& beam, double nepers_per_mhz) {
  const double sigma_mhz = beam.bandwidth * beam.frequency_mhz / 2.3548;  // half the amplitude at half the bandwidth
  double sum = 0.0, all = 0.0;
  for (double f = 0.0; f < 4.0 * beam.frequency_mhz; f += 1e-3) {
    const double u = (f - beam.frequency_mhz) / sigma_mhz;
    all += std::exp(-0.5 * u * u);
    sum += std::exp(-0.5 * u * u - nepers_per_mhz * (f - beam.frequency_mhz));
  }
  return 20.0 * std::log10(sum / all);
}

TEST(Downshift, RaisesTheLevelByTheSpectralGain) {
  const Transducer transducer = convex();
  Artefacts shifting = losses();
  shifting.downshift = true;
  const SceneBox box = box_for(transducer, 160.0, 2.0);
  const ScenePtr tissue = homogeneous_scene(box, TestTissue::kTissue);
  BMode with(tissue, transducer, plain(transducer, shifting)), without(tissue, transducer, plain(transducer, losses()));
  const BasebandFrame &a = with.render({}), &b = without.render({});
  for (const double depth_mm : {40.0, 80.0, 120.0, 150.0}) {
    const PatchBounds bounds{10, 246, depth_mm - 5.0, depth_mm + 5.0};
    const double nepers_per_mhz = 2.0 * 0.5 * 0.1 * depth_mm * std::log(10.0) / 20.0;
    // Other scatterers carry more weight in the wider beam: the means of both frames differ by their spread.
    EXPECT_NEAR(level_db(envelope_patch(a, bounds)) - level_db(envelope_patch(b, bounds)),
                spectral_gain_db(b.beam, nepers_per_mhz), 0.35)
        << depth_mm;
  }
}

TEST(Downshift, LowersTheFrequencyAndWidensTheBeam) {
  Beam beam = make_beam(convex(), 3.5, 80.0);
  beam.downshift_per_mm = nominal_downshift_per_mm(beam);
  constexpr double kDeep_mm = 157.0;
  const double here_mhz = kScannerSpeed_mm_per_us / beam.wavelength_at_mm(kDeep_mm);
  EXPECT_NEAR(here_mhz - beam.frequency_mhz, -0.64, 0.01);
  Beam straight = beam;
  straight.downshift_per_mm = 0.0;
  // Deep behind the focus both beams are limited by diffraction.
  EXPECT_NEAR(beam.lateral_sigma_mm(kDeep_mm) / straight.lateral_sigma_mm(kDeep_mm), 1.22, 0.04);
  EXPECT_DOUBLE_EQ(beam.lateral_sigma_mm(0.0), straight.lateral_sigma_mm(0.0));
  EXPECT_GT(beam.elevation_sigma_mm(kDeep_mm), straight.elevation_sigma_mm(kDeep_mm));
  EXPECT_DOUBLE_EQ(beam.axial_sigma_mm, straight.axial_sigma_mm) << "the pulse keeps its bandwidth";
  // No negative frequencies, at any depth.
  EXPECT_LE(beam.wavelength_at_mm(1e6), straight.wavelength_mm / (1.0 - kMostDownshift) * 1.0001);
}

TEST(Downshift, NeedsAttenuation) {
  const Transducer transducer = convex();
  Artefacts only_shift = no_artefacts();
  only_shift.downshift = true;
  const ScenePtr tissue = homogeneous_scene(box_for(transducer, 160.0, 2.0), TestTissue::kTissue);
  BMode with(tissue, transducer, plain(transducer, only_shift)), without(tissue, transducer, plain(transducer));
  const BasebandFrame &a = with.render({}), &b = without.render({});
  EXPECT_EQ(a.re, b.re);
  EXPECT_EQ(a.im, b.im);
}

}  // namespace
}  // namespace trocar::ultrasound
