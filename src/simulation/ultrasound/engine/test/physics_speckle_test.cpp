// Speckle of the engine against the statistics of a circular Gaussian field, in several depths and transducers.

#include "ultrasound/test/physics_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

constexpr int kSpeckleFrames = 6;

/// A block that kSpeckleFrames frames, kFrameStep_mm apart, fit into. One tissue needs no fine grid.
SceneBox box_of_frames(const Transducer& transducer) {
  SceneBox box = box_for(transducer, transducer.depth_mm, 2.0);
  box.half_thickness_mm = 0.5 * kSpeckleFrames * kFrameStep_mm + 8.0;
  return box;
}

struct Speckle {
  std::vector<float> envelope, independent;
  double cells = 0.0;
};

/// Speckle of a band of depth, gathered over frames; every line but those at the edges.
Speckle speckle_of(BMode& engine, double near_mm, double far_mm) {
  Speckle speckle;
  for (int n = 0; n < kSpeckleFrames; ++n) {
    const BasebandFrame& frame =
        engine.render({at_elevation(kFrameStep_mm * (n - 0.5 * (kSpeckleFrames - 1))), {}, 0.0});
    const EchoPatch patch = envelope_patch(frame, {10, frame.geometry.lines - 10, near_mm, far_mm});
    const SpeckleCorrelation correlation = speckle_correlation(intensity_of(patch));
    speckle.cells += correlation.cells;
    speckle.envelope.insert(speckle.envelope.end(), patch.values.begin(), patch.values.end());
    const std::vector<float> apart = thinned(patch, correlation, 2.0);
    speckle.independent.insert(speckle.independent.end(), apart.begin(), apart.end());
  }
  return speckle;
}

struct SpeckleCase {
  const char* transducer;
  double near_mm, far_mm;
};
class FullyDevelopedSpeckle : public ::testing::TestWithParam<SpeckleCase> {};

TEST_P(FullyDevelopedSpeckle, IsRayleigh) {
  const Transducer transducer = shipped(GetParam().transducer);
  BMode engine(homogeneous_scene(box_of_frames(transducer), TestTissue::kLossless), transducer, plain(transducer));
  const Speckle speckle = speckle_of(engine, GetParam().near_mm, GetParam().far_mm);
  const SpeckleMoments moments = speckle_moments(speckle.envelope);
  RecordProperty("cells", std::to_string(speckle.cells));
  RecordProperty("snr", std::to_string(moments.snr));
  RecordProperty("m", std::to_string(moments.nakagami_m));
  EXPECT_GT(speckle.cells, 5000.0);
  EXPECT_NEAR(moments.snr, kRayleighSnr, 0.05);
  EXPECT_NEAR(moments.nakagami_m, 1.0, 0.05);
  EXPECT_NEAR(moments.nakagami_m_ml, 1.0, 0.05);
  EXPECT_GT(speckle.independent.size(), 500u);
  EXPECT_LT(fit_rayleigh(speckle.independent).statistic, kRayleighStatistic999) << "one of nine cases";
  EXPECT_NEAR(10.0 * std::log10(moments.mean_intensity), 0.0, 0.4) << "1.0 is speckle's root mean square";
}

INSTANTIATE_TEST_SUITE_P(DepthsAndTransducers, FullyDevelopedSpeckle,
                         ::testing::Values(SpeckleCase{"C5-2", 15, 45}, SpeckleCase{"C5-2", 60, 90},
                                           SpeckleCase{"C5-2", 100, 125}, SpeckleCase{"C5-2", 130, 158},
                                           SpeckleCase{"L14-5", 5, 12}, SpeckleCase{"L14-5", 15, 25},
                                           SpeckleCase{"L14-5", 28, 39}, SpeckleCase{"P4-2", 40, 90},
                                           SpeckleCase{"liver-sweep", 60, 100}),
                         [](const ::testing::TestParamInfo<SpeckleCase>& each) {
                           std::string name = each.param.transducer;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name + "_" + std::to_string(static_cast<int>(each.param.near_mm)) + "mm";
                         });

TEST(Speckle, ScattersFollowsBackscatterAndStaysRayleigh) {
  const Transducer transducer = convex();
  const ScenePtr scene = homogeneous_scene(box_of_frames(transducer), TestTissue::kLossless);
  BMode engine(scene, transducer, plain(transducer));
  BMode brighter(
      with_table(scene, [](AcousticTable& t) { t.tissues[index_of(TestTissue::kLossless)].backscatter_db = 9.0; }),
      transducer, plain(transducer));
  const EchoPatch a = envelope_patch(engine.render({}), {20, 236, 40, 140});
  const EchoPatch b = envelope_patch(brighter.render({}), {20, 236, 40, 140});
  EXPECT_NEAR(level_db(b) - level_db(a), 9.0, 0.01);
  EXPECT_NEAR(normalised_correlation(a.values, b.values), 1.0, 1e-4);
}

TEST(Speckle, KeepsItsPatternAtLessDetail) {
  const Transducer transducer = convex();
  const ScenePtr scene = homogeneous_scene(box_of_frames(transducer), TestTissue::kLossless);
  const Acquisition full = plain(transducer);
  Acquisition fewer = full, coarse = full;
  fewer.scatterers = 2.0;
  coarse.samples = full.samples / 2;
  coarse.lines = full.lines / 2;
  BMode engine(scene, transducer, full);
  const EchoPatch a = envelope_patch(engine.render({}), {20, 236, 60, 90});
  const SpeckleMoments moments = speckle_moments(a.values);
  EXPECT_GT(moments.snr, 1.86);
  engine.set_acquisition(fewer);
  const EchoPatch b = envelope_patch(engine.render({}), {20, 236, 60, 90});
  EXPECT_NEAR(level_db(b), level_db(a), 0.5);
  EXPECT_GT(normalised_correlation(a.values, b.values), 0.45) << "half of the same scatterers";
  engine.set_acquisition(coarse);
  const EchoPatch c = envelope_patch(engine.render({}), {10, 118, 60, 90});
  EXPECT_NEAR(level_db(c), level_db(a), 0.5);
}

TEST(Speckle, IsNotFullyDevelopedForFewScatterers) {
  const Transducer transducer = convex();
  const ScenePtr scene = homogeneous_scene(box_of_frames(transducer), TestTissue::kLossless);
  BMode engine(
      with_table(scene, [](AcousticTable& t) { t.tissues[index_of(TestTissue::kLossless)].scatterer_share = 0.05; }),
      transducer, plain(transducer));
  const Speckle speckle = speckle_of(engine, 60, 90);
  const SpeckleMoments moments = speckle_moments(speckle.envelope);
  EXPECT_LT(moments.nakagami_m, 0.9);
  EXPECT_LT(moments.snr, 1.86);
  EXPECT_NEAR(10.0 * std::log10(moments.mean_intensity), 0.0, 0.6) << "fewer, but stronger";
}

TEST(Speckle, WidthsMatchTheBeam) {
  for (const char* name : {"C5-2", "L14-5"}) {
    const Transducer transducer = shipped(name);
    BMode engine(homogeneous_scene(box_of_frames(transducer), TestTissue::kLossless), transducer, plain(transducer));
    for (const double share : {0.3, 0.5, 0.8}) {
      const double depth_mm = share * transducer.depth_mm;
      const double half_mm = 0.03 * transducer.depth_mm;  // the beam's width changes little over it
      double axial_mm = 0.0, lateral_mm = 0.0;
      for (int n = 0; n < kSpeckleFrames; ++n) {
        const BasebandFrame& frame =
            engine.render({at_elevation(kFrameStep_mm * (n - 0.5 * (kSpeckleFrames - 1))), {}, 0.0});
        const SpeckleCorrelation c = speckle_correlation(intensity_of(
            envelope_patch(frame, {10, frame.geometry.lines - 10, depth_mm - half_mm, depth_mm + half_mm})));
        axial_mm += c.axial_fwhm_mm / kSpeckleFrames;
        lateral_mm += c.lateral_fwhm_mm / kSpeckleFrames;
      }
      const Beam beam = make_beam(transducer, transducer.frequency_mhz, transducer.focus_mm);
      constexpr double kFwhm = 2.3548;
      EXPECT_NEAR(axial_mm, kFwhm * beam.axial_sigma_mm, 0.1 * kFwhm * beam.axial_sigma_mm) << name << depth_mm;
      EXPECT_NEAR(lateral_mm, kFwhm * beam.lateral_sigma_mm(depth_mm), 0.1 * kFwhm * beam.lateral_sigma_mm(depth_mm))
          << name << depth_mm;
    }
  }
}

}  // namespace
}  // namespace trocar::ultrasound
