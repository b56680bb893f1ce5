// Slices of panoramas with a closed form: places, thickness, gray levels.

#include "motion/testing/sliding_motion.h"
#include "ultrasound/panorama/detail/panorama_sampler.h"
#include "ultrasound/panorama/test/panorama_lab.h"
#include "ultrasound/scanner/scanner.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

constexpr double kSpacing_mm = 0.8;

/// A homogeneous, lossless patient in front of the linear transducer.
ScenePtr lossless(const Transducer& transducer) {
  return homogeneous_scene(box_for(transducer, 60.0), TestTissue::kLossless);
}

Pose turned(const Vec3& axis, double angle_rad, const Vec3& p) {
  return {Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix(), p};
}

TEST(PanoramaSlice, ReproducesARampInARotatedPanorama) {
  const Transducer transducer = linear();
  const Vec3 slope(0.7, 1.1, 0.9);  // gray per mm
  const auto gray_of = [&](const Vec3& p_U) { return 120.0 + slope.dot(p_U); };
  const Pose X_PU = turned({1.0, 2.0, -1.0}, 0.3, {2.0, -1.5, 1.0});
  const auto panorama = make(paint_gray(Vec3(-60, -50, -50), Vec3(60, 90, 50), kSpacing_mm,
                                        [&](const Vec3& p_U) { return std::lround(gray_of(p_U)); }),
                             X_PU);
  PanoramaEngine engine(lossless(transducer), panorama, transducer, small_scan(transducer));
  const Pose X_PT = turned({0.0, 0.0, 1.0}, 0.02, {1.0, 0.5, 2.0});
  const BasebandFrame& frame = engine.render({X_PT, {}, 0.0});
  EXPECT_DOUBLE_EQ(engine.panorama_share(), 1.0);
  EXPECT_EQ(engine.ray_cast_lines(), 0);
  for (int line = 1; line < frame.geometry.lines; line += 9)
    for (int sample = 20; sample < frame.geometry.samples; sample += 17) {
      const Vec3 p_U = X_PU.inverse() * (X_PT * place_of(frame, line, sample));
      // Rounding to whole gray values and to levels: 0.12 dB each; the dent of the face moves tissue by 0.5 mm.
      EXPECT_NEAR(level_at(frame, line, sample), linear_level_db(gray_of(p_U)), 0.4) << line << ", " << sample;
    }
}

TEST(PanoramaSlice, PlacesABallByThePanoramaPose) {
  const Transducer transducer = linear();
  const Vec3 centre_P(4.0, 27.0, 0.0);
  const Pose X_PU = turned({0.3, 1.0, 0.2}, 0.4, {7.0, -3.0, 2.0});
  const Vec3 centre_U = X_PU.inverse() * centre_P;
  constexpr double kRadius_mm = 5.0;
  const auto panorama =
      make(paint_gray(Vec3(-60, -50, -50), Vec3(60, 90, 50), kSpacing_mm,
                      [&](const Vec3& p_U) { return (p_U - centre_U).norm() < kRadius_mm ? 220 : 60; }),
           X_PU);
  PanoramaEngine engine(lossless(transducer), panorama, transducer, small_scan(transducer));
  const BasebandFrame& frame = engine.render({Pose(), {}, 0.0});
  Vec3 sum = Vec3::Zero();
  double area_mm2 = 0.0;
  const double cell_mm2 = frame.geometry.sample_mm() * frame.geometry.line_spacing_mm(30.0);
  for (int line = 0; line < frame.geometry.lines; ++line)
    for (int sample = 0; sample < frame.geometry.samples; ++sample) {
      if (level_at(frame, line, sample) < linear_level_db(140)) continue;
      sum += cell_mm2 * place_of(frame, line, sample);
      area_mm2 += cell_mm2;
    }
  ASSERT_GT(area_mm2, 0.0);
  EXPECT_LT((sum / area_mm2 - centre_P).norm(), 0.5 * kSpacing_mm);
  EXPECT_NEAR(std::sqrt(area_mm2 / std::numbers::pi), kRadius_mm, 0.5 * kSpacing_mm);
}

TEST(PanoramaSlice, BallFollowsItsTissue) {
  const Transducer transducer = linear();
  const Vec3 centre_A(4.0, 27.0, 0.0);
  const Pose X_PU = turned({0.3, 1.0, 0.2}, 0.4, {7.0, -3.0, 2.0});
  const Vec3 centre_U = X_PU.inverse() * centre_A;
  const auto panorama = make(paint_gray(Vec3(-60, -50, -50), Vec3(60, 90, 50), kSpacing_mm,
                                        [&](const Vec3& p_U) { return (p_U - centre_U).norm() < 2.5 ? 220 : 60; }),
                             X_PU);
  PanoramaEngine engine(lossless(transducer), panorama, transducer, small_scan(transducer));
  using namespace motion::testing;
  const auto model = made(whole_body({ramp({0.0, 9.0, 0.0}, centre_A - 30.0 * Vec3::UnitX(), Vec3::UnitX(), 90.0),
                                      bump({-6.0, 0.0, 0.0}, centre_A, 35.0)}));
  const motion::MotionClock clock{model.get(), motion::testing::sliding_drive()};
  for (int n = 0; n < 10; ++n) {
    BModeInput input;
    input.motion = clock.at(0.4 * n);
    const BasebandFrame& frame = engine.render(input);
    Vec3 sum = Vec3::Zero();
    double weight = 0.0;
    for (int line = 0; line < frame.geometry.lines; ++line)
      for (int sample = 0; sample < frame.geometry.samples; ++sample) {
        if (level_at(frame, line, sample) < linear_level_db(140)) continue;
        sum += place_of(frame, line, sample);
        weight += 1.0;
      }
    ASSERT_GT(weight, 0.0);
    EXPECT_LT((sum / weight - input.motion.to_now(centre_A)).norm(), 0.3) << n;
  }
}

TEST(PanoramaSlice, WeightsAPlateByItsDistanceFromThePlane) {
  const Transducer transducer = linear();
  Acquisition acquisition = small_scan(transducer);
  acquisition.planes = 9;
  constexpr double kSheet_mm = 0.4;
  // The plate fills the voxels of one layer of z: between the layers it falls off linearly (in dB).
  for (const double z_mm : {0.0, 0.8, 1.6}) {
    const auto panorama = make(paint_gray(Vec3(-45, -20, -20), Vec3(45, 80, 20), kSheet_mm, [&](const Vec3& p_U) {
      return std::abs(p_U.z() - z_mm) < 0.25 * kSheet_mm ? 250 : 5;
    }));
    PanoramaEngine engine(lossless(transducer), panorama, transducer, acquisition);
    const BasebandFrame& frame = engine.render({Pose(), {}, 0.0});
    const int sample = 150;
    const double sigma_mm = frame.beam.elevation_sigma_mm((sample + 0.5) * frame.geometry.sample_mm());
    const detail::BeamPlanes planes = detail::make_beam_planes(9);
    double expected = 0.0;
    for (int n = 0; n < planes.count; ++n) {
      const auto at = static_cast<std::size_t>(n);
      const double away = std::abs(static_cast<double>(planes.zeta[at]) * sigma_mm - z_mm) / kSheet_mm;
      const double gray = away < 1.0 ? 250.0 - 245.0 * away : 5.0;
      expected += static_cast<double>(planes.share[at]) * std::pow(10.0, linear_level_db(gray) / 10.0);
    }
    EXPECT_NEAR(level_at(frame, 31, sample), 10.0 * std::log10(expected), 0.6) << z_mm;
  }
}

TEST(PanoramaSlice, PlaneWeightsMatchTheBeamVariance) {
  for (const int count : {3, 5, 7, 9}) {
    const detail::BeamPlanes planes = detail::make_beam_planes(count);
    float sum = 0.0F, squares = 0.0F;
    for (std::size_t n = 0; n < static_cast<std::size_t>(count); ++n) {
      sum += planes.share[n];
      squares += planes.share[n] * planes.zeta[n] * planes.zeta[n];
    }
    EXPECT_NEAR(sum, 1.0F, 1e-6F);
    EXPECT_NEAR(squares, 0.5F, 0.1F) << count;  // planes end at 1.5 sigmas
  }
}

TEST(PanoramaSlice, DefaultSettingsReproduceThePanoramaGray) {
  const Transducer transducer = linear();
  for (const int gray : {20, 70, 140, 230}) {
    const auto panorama =
        make(paint_gray(kFirst_mm, kLast_mm, 1.0, [&](const Vec3&) { return gray; }), Pose(), GrayMap::kSoft);
    PanoramaEngine engine(lossless(transducer), panorama, transducer, small_scan(transducer));
    Scanner scanner(320, 240);
    scanner.artefacts = no_artefacts();
    scanner.show(engine.render({Pose(), {}, 0.0}), 1);
    EXPECT_NEAR(scanner.polar()[32 * 256 + 128], gray, 2) << gray;  // one level is at most two gray values
  }
}

TEST(PanoramaSlice, RaisesTheLevelByTheGain) {
  const Transducer transducer = linear();
  const auto panorama = make(paint_gray(kFirst_mm, kLast_mm, 1.0, [](const Vec3&) { return 100; }));
  PanoramaEngine engine(lossless(transducer), panorama, transducer, small_scan(transducer));
  const BasebandFrame& frame = engine.render({Pose(), {}, 0.0});
  Scanner scanner(320, 240);
  scanner.artefacts = no_artefacts();
  scanner.settings.gray_map = GrayMap::kLinear;
  scanner.show(frame, 1);
  const int before = scanner.polar()[32 * 256 + 128];
  scanner.settings.gain_db = 6.0;
  scanner.show(frame, 1);
  EXPECT_EQ(before, 100);
  EXPECT_NEAR(scanner.polar()[32 * 256 + 128] - before, 255.0 * 6.0 / 60.0, 1.0);
}

TEST(Panorama, RefusesEmptyVolumesAndImpossibleNumbers) {
  const volume::LabelGrid black = paint_gray(Vec3(0, 0, 0), Vec3(9, 9, 9), 1.0, [](const Vec3&) { return 0; });
  const volume::LabelGrid gray = paint_gray(Vec3(0, 0, 0), Vec3(9, 9, 9), 1.0, [](const Vec3&) { return 9; });
  EXPECT_FALSE(make_panorama(black, Pose()));
  EXPECT_FALSE(make_panorama(volume::LabelGrid{}, Pose()));
  EXPECT_FALSE(make_panorama(gray, Pose(), {.dynamic_range_db = std::nan("")}));
  EXPECT_FALSE(make_panorama(gray, Pose(), {.dynamic_range_db = 500.0}));
  EXPECT_FALSE(make_panorama(gray, Pose(), {.fade_mm = 0.0}));
  EXPECT_TRUE(make_panorama(gray, Pose()));
}

TEST(Panorama, WeightFallsToZeroTowardsUnknownVoxels) {
  const auto panorama =
      make(paint_gray(Vec3(0, 0, 0), Vec3(50, 40, 40), 1.0, [](const Vec3& p) { return p.x() < 25.0 ? 80 : 0; }));
  ASSERT_TRUE(panorama);
  int last = 255;
  for (int i = 14; i <= 50; ++i) {
    const int weight = panorama->weights[panorama->geometry.offset({i, 20, 20})];
    EXPECT_LE(weight, last) << i;
    last = weight;
    if (i >= 24) {
      EXPECT_EQ(weight, 0) << i;
    }
  }
  EXPECT_EQ(panorama->weights[panorama->geometry.offset({14, 20, 20})], 255);
  EXPECT_EQ(panorama->weights[panorama->geometry.offset({0, 20, 20})], 0) << "the border of the grid is unknown, too";
}

}  // namespace
}  // namespace trocar::ultrasound
