// Shadows, transitions and needles of the panorama engine, and what its frames depend on.

#include <array>
#include <limits>

#include "core/parallel.h"
#include "core/testing/allocation_guard.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/panorama/test/panorama_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

constexpr int kGray = 110;

std::shared_ptr<const Panorama> even(const Vec3& first = kFirst_mm, const Vec3& last = kLast_mm) {
  return make(paint_gray(first, last, 1.0, [](const Vec3&) { return kGray; }));
}

Acquisition with_artefacts(const Transducer& transducer) {
  Acquisition acquisition = small_scan(transducer);
  acquisition.artefacts = Artefacts{};
  acquisition.steering_angles = 3;
  acquisition.planes = 5;
  return acquisition;
}

/// A rib in lossy tissue: the tissue's own losses must not appear.
ScenePtr rib_scene(const Transducer& transducer, TestTissue tissue) {
  return slab_scene(box_for(transducer, 60.0, 0.5), TestTissue::kTissue, {5.0, 20.0, 26.0, tissue});
}

TEST(PanoramaShadow, StartsBehindTheBone) {
  const Transducer transducer = linear();
  Acquisition acquisition = small_scan(transducer);
  acquisition.artefacts.attenuation = true;
  PanoramaEngine engine(rib_scene(transducer, TestTissue::kBone), even(), transducer, acquisition);
  const BasebandFrame& frame = engine.render({Pose(), {}, 0.0});
  const auto sample_at = [&](double mm) { return static_cast<int>(mm / frame.geometry.sample_mm()); };
  const int middle = frame.geometry.lines / 2;
  for (double mm = 5.0; mm < 19.0; mm += 1.0)
    EXPECT_NEAR(level_at(frame, middle, sample_at(mm)), linear_level_db(kGray), 0.3) << mm;
  // The surface's echo stays for a millimetre; bone of 10 dB/cm/MHz leaves nothing behind its 6 mm.
  EXPECT_LT(level_at(frame, middle, sample_at(23.0)), linear_level_db(kGray) - 10.0);
  for (double mm = 28.0; mm < 49.0; mm += 3.0)
    EXPECT_LT(level_at(frame, middle, sample_at(mm)), linear_level_db(kGray) - 25.0) << mm;
  // Beside the rib.
  for (double mm = 5.0; mm < 45.0; mm += 5.0)
    EXPECT_NEAR(level_at(frame, 3, sample_at(mm)), linear_level_db(kGray), 0.5) << mm;
}

TEST(PanoramaShadow, IsNotCastBySoftTissue) {
  const Transducer transducer = linear();
  Acquisition acquisition = small_scan(transducer);
  acquisition.artefacts.attenuation = true;
  for (const TestTissue tissue : {TestTissue::kLossy, TestTissue::kWater, TestTissue::kDense}) {
    PanoramaEngine engine(rib_scene(transducer, tissue), even(), transducer, acquisition);
    const BasebandFrame& frame = engine.render({Pose(), {}, 0.0});
    for (int sample = 30; sample < 256; sample += 25)
      EXPECT_NEAR(level_at(frame, 32, sample), linear_level_db(kGray), 0.3)
          << static_cast<int>(tissue) << ", " << sample;
  }
}

TEST(PanoramaShadow, IsCastByGasOnlyWithAttenuation) {
  const Transducer transducer = linear();
  Acquisition acquisition = small_scan(transducer);
  acquisition.artefacts.attenuation = true;
  PanoramaEngine engine(rib_scene(transducer, TestTissue::kGas), even(), transducer, acquisition);
  EXPECT_LT(level_at(engine.render({Pose(), {}, 0.0}), 32, 200), linear_level_db(kGray) - 20.0);
  acquisition.artefacts.attenuation = false;
  engine.set_acquisition(acquisition);
  EXPECT_NEAR(level_at(engine.render({Pose(), {}, 0.0}), 32, 200), linear_level_db(kGray), 0.3);
}

TEST(PanoramaFade, EqualsTheRayCastFrameWithoutCoverage) {
  const Transducer transducer = linear();
  const Acquisition acquisition = with_artefacts(transducer);
  const ScenePtr scene = rib_scene(transducer, TestTissue::kBone);
  PanoramaEngine engine(scene, even(Vec3(200, 200, 200), Vec3(230, 230, 230)), transducer, acquisition);
  BMode ray_cast(scene, transducer, acquisition);
  const std::array<Vec3, 2> shaft = {Vec3(-25.0, 5.0, 0.2), Vec3(5.0, 30.0, 0.1)};
  NeedleEcho needle;
  needle.shaft_P = shaft;
  const BModeInput input{Pose::translation(Vec3(1.0, 0.5, 2.0)), {&needle, 1}, 0.0};
  const BasebandFrame& frame = engine.render(input);
  const BasebandFrame& expected = ray_cast.render(input);
  EXPECT_EQ(engine.panorama_share(), 0.0);
  EXPECT_TRUE(frame.re == expected.re);
  EXPECT_TRUE(frame.im == expected.im);
  EXPECT_TRUE(frame.contact == expected.contact);
}

TEST(PanoramaFade, WeightsOfBothEnginesAddUpToOne) {
  // The ray-cast engine renders an empty medium: what is left of the panorama's amplitude is its weight.
  const Transducer transducer = linear();
  const ScenePtr scene = homogeneous_scene(box_for(transducer, 60.0), TestTissue::kWater);
  PanoramaEngine engine(scene, even(kFirst_mm, Vec3(3.0, 80.0, 22.0)), transducer, small_scan(transducer));
  const BasebandFrame& frame = engine.render({Pose(), {}, 0.0});
  double last = 1.02;  // half a level
  int partly = 0;
  constexpr double kFloor = 0.02;  // echoes of water, amplified by the TGC
  for (int line = 10; line < frame.geometry.lines; ++line) {
    const double part = std::pow(10.0, (level_at(frame, line, 128) - linear_level_db(kGray)) / 20.0);
    EXPECT_LE(part, last + kFloor) << line;
    partly += part > 0.05 && part < 0.95 ? 1 : 0;
    last = part;
  }
  EXPECT_GE(partly, 3);
  EXPECT_LT(last, kFloor);
  EXPECT_GT(engine.panorama_share(), 0.3);
  EXPECT_LT(engine.panorama_share(), 0.7);
  // A quarter of the scanlines or more is far from the border and needs no ray casting.
  EXPECT_LT(engine.ray_cast_lines(), 48);
}

TEST(PanoramaFade, KeepsTheLiverLevelAcrossTheBorder) {
  const Transducer transducer = convex();
  Acquisition acquisition = small_scan(transducer);
  acquisition.lines = 128;
  acquisition.artefacts.attenuation = true;  // of 0.5 dB/cm/MHz, as the TGC calculates
  const ScenePtr scene = homogeneous_scene(box_for(transducer, 60.0), TestTissue::kTissue);
  // Liver's speckle is 0 dB: gray 191 of the linear map.
  PanoramaEngine engine(scene,
                        make(paint_gray(Vec3(-90, -40, -30), Vec3(0, 90, 30), 1.0, [](const Vec3&) { return 191; })),
                        transducer, acquisition);
  const BasebandFrame& frame = engine.render({Pose(), {}, 0.0});
  const auto mean_db = [&](int first, int last) {
    double power = 0.0;
    for (int line = first; line < last; ++line)
      for (int sample = 60; sample < 240; ++sample) power += std::pow(10.0, level_at(frame, line, sample) / 10.0);
    return 10.0 * std::log10(power / (180.0 * (last - first)));
  };
  EXPECT_NEAR(mean_db(10, 40), 0.0, 0.3);
  // Speckle of about 200 cells: its mean varies by 0.3 dB.
  EXPECT_NEAR(mean_db(88, 118), 0.0, 1.0);
}

TEST(PanoramaFade, ShowsTheRayCastImageForAFaceInAir) {
  const Transducer transducer = linear();
  const Acquisition acquisition = with_artefacts(transducer);
  const ScenePtr scene = gap_scene(box_for(transducer, 60.0), TestTissue::kTissue, -100.0, 5.0);
  PanoramaEngine engine(scene, even(), transducer, acquisition);
  BMode ray_cast(scene, transducer, acquisition);
  const BasebandFrame& frame = engine.render({Pose(), {}, 0.0});
  const BasebandFrame& expected = ray_cast.render({Pose(), {}, 0.0});
  EXPECT_EQ(coupled_share(frame), 0.0);
  EXPECT_TRUE(frame.re == expected.re && frame.im == expected.im);
  EXPECT_EQ(engine.panorama_share(), 0.0);
}

TEST(PanoramaFade, OnlyScanlinesWithContactShowThePanorama) {
  const Transducer transducer = linear();
  const ScenePtr scene = gap_scene(box_for(transducer, 60.0), TestTissue::kTissue, 4.0, 5.0);
  PanoramaEngine engine(scene, even(), transducer, with_artefacts(transducer));
  const BasebandFrame& frame = engine.render({Pose(), {}, 0.0});
  EXPECT_EQ(frame.contact.back(), 0.0F);
  EXPECT_NEAR(level_at(frame, 10, 100), linear_level_db(kGray), 1.5);
  EXPECT_LT(level_at(frame, 62, 100), linear_level_db(kGray) - 15.0);
}

TEST(PanoramaNeedle, IsDrawnOverThePanoramaAndShadowsIt) {
  const Transducer transducer = linear();
  Acquisition acquisition = small_scan(transducer);
  acquisition.artefacts.attenuation = true;
  PanoramaEngine engine(homogeneous_scene(box_for(transducer, 60.0), TestTissue::kLossless), even(), transducer,
                        acquisition);
  const std::array<Vec3, 2> shaft = {Vec3(-25.0, 24.0, 0.0), Vec3(10.0, 25.0, 0.0)};
  NeedleEcho needle;
  needle.shaft_P = shaft;
  needle.diameter_mm = 2.0;
  const std::vector<float> before = engine.render({Pose(), {}, 0.0}).re;
  const double bare_db = level_at(engine.render({Pose(), {}, 0.0}), 20, 220);
  const BasebandFrame& frame = engine.render({Pose(), {&needle, 1}, 0.0});
  double brightest = -200.0;
  int at = 0;
  for (int sample = 0; sample < 256; ++sample)
    if (level_at(frame, 20, sample) > brightest) brightest = level_at(frame, 20, at = sample);
  EXPECT_NEAR((at + 0.5) * frame.geometry.sample_mm(), 24.5, 0.6);
  EXPECT_GT(brightest, linear_level_db(kGray) + 20.0);
  EXPECT_LT(level_at(frame, 20, 220), bare_db - 0.5);
  // It leaves no trace in the next frame.
  EXPECT_TRUE(engine.render({Pose(), {}, 0.0}).re == before);
}

/// A frame of a half-covered scan with a needle.
BModeInput half_covered(const NeedleEcho& needle, double z_mm) {
  return {Pose::translation(Vec3(0.5, 0.5, z_mm)), {&needle, 1}, 0.0};
}

TEST(PanoramaFrame, DependsOnNeitherThreadsNorEarlierFrames) {
  const Transducer transducer = linear();
  const Acquisition acquisition = with_artefacts(transducer);
  const ScenePtr scene = rib_scene(transducer, TestTissue::kBone);
  const auto panorama = even(kFirst_mm, Vec3(5.0, 80.0, 22.0));
  const std::array<Vec3, 2> shaft = {Vec3(-25.0, 5.0, 0.2), Vec3(12.0, 30.0, 0.1)};
  NeedleEcho needle;
  needle.shaft_P = shaft;
  PanoramaEngine fresh(scene, panorama, transducer, acquisition), used(scene, panorama, transducer, acquisition);
  const BasebandFrame& expected = fresh.render(half_covered(needle, 1.0));
  used.render({Pose(Eigen::AngleAxisd(0.4, Vec3::UnitY()).toRotationMatrix(), Vec3(3.0, 1.0, -2.0)), {}, 0.0});
  used.render(half_covered(needle, -3.0));
  used.render({Pose::translation(Vec3(0.0, -40.0, 0.0)), {}, 0.0});
  BasebandFrame again;
  run_on_threads(1, [&] { again = used.render(half_covered(needle, 1.0)); });
  EXPECT_TRUE(again.re == expected.re);
  EXPECT_TRUE(again.im == expected.im);
}

TEST(PanoramaFrame, AllocatesNothingAfterTheFirst) {
  const Transducer transducer = linear();
  const ScenePtr scene = rib_scene(transducer, TestTissue::kBone);
  const std::array<Vec3, 2> shaft = {Vec3(-25.0, 5.0, 0.2), Vec3(12.0, 30.0, 0.1)};
  NeedleEcho needle;
  needle.shaft_P = shaft;
  for (const double end_mm : {45.0, 5.0}) {
    PanoramaEngine engine(scene, even(kFirst_mm, Vec3(end_mm, 80.0, 22.0)), transducer, with_artefacts(transducer));
    run_on_threads(1, [&] {
      engine.render(half_covered(needle, 0.0));
      const AllocationGuard guard;
      engine.render(half_covered(needle, 1.0));
      EXPECT_EQ(guard.count(), 0U);
    });
  }
}

TEST(PanoramaFrame, OmitsThePanoramaForInvalidPoses) {
  const Transducer transducer = linear();
  PanoramaEngine engine(rib_scene(transducer, TestTissue::kBone), even(), transducer, with_artefacts(transducer));
  const std::vector<float> usual = engine.render({Pose(), {}, 0.0}).re;
  const std::array<Vec3, 2> shaft = {Vec3::Constant(std::nan("")), Vec3::Constant(1e300)};
  NeedleEcho needle;
  needle.shaft_P = shaft;
  for (const double mm : {1e5, -1e30, std::nan(""), std::numeric_limits<double>::infinity()}) {
    engine.render({Pose::translation(Vec3::Constant(mm)), {&needle, 1}, 0.0});
    EXPECT_EQ(engine.panorama_share(), 0.0) << mm;
  }
  EXPECT_TRUE(engine.render({Pose(), {}, 0.0}).re == usual);
}

TEST(PanoramaFrame, RollingRenewsOnlyItsScanlines) {
  const Transducer transducer = linear();
  const ScenePtr scene = rib_scene(transducer, TestTissue::kBone);
  PanoramaEngine engine(scene, even(), transducer, with_artefacts(transducer));
  const std::vector<float> before = engine.render({Pose(), {}, 0.0}).im;
  const BasebandFrame& frame = engine.render({Pose::translation(Vec3(6.0, 0.0, 0.0)), {}, 0.0, {0, 32}});
  EXPECT_EQ(frame.renewed, (LineRange{0, 32}));
  const auto is_same = [&](std::size_t line) {
    return std::equal(before.begin() + static_cast<std::ptrdiff_t>(line * 256),
                      before.begin() + static_cast<std::ptrdiff_t>((line + 1) * 256),
                      frame.im.begin() + static_cast<std::ptrdiff_t>(line * 256));
  };
  EXPECT_TRUE(is_same(40) && is_same(63));
  EXPECT_FALSE(is_same(25)) << "the rib's shadow has moved there";
}

}  // namespace
}  // namespace trocar::ultrasound
