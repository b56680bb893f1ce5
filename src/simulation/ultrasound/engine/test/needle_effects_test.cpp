#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/testing/allocation_guard.h"
#include "ultrasound/engine/detail/needle_image.h"
#include "ultrasound/engine/test/needle_alone.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

/// Level behind a needle against that without it, over the scanlines beside the middle.
double shadow_db(BMode& engine, const NeedleEcho& needle, double from_mm, double to_mm) {
  const BasebandFrame without = seen(engine, {}), with = seen(engine, needle);
  const int middle = without.geometry.lines / 2;
  double power[2] = {0.0, 0.0};
  for (int line = middle - 1; line <= middle + 1; ++line)
    for (int s = static_cast<int>(from_mm / without.geometry.sample_mm());
         s < static_cast<int>(to_mm / without.geometry.sample_mm()); ++s) {
      power[0] += std::pow(envelope(without, line, s), 2);
      power[1] += std::pow(envelope(with, line, s), 2);
    }
  return 10.0 * std::log10(power[1] / power[0]);
}

TEST(NeedleEffects, ShadowDepthMatchesTheCoveredAperture) {
  BMode engine = engine_in(TestTissue::kLossless);
  const double one_way_mm = std::numbers::sqrt2 * seen(engine, {}).beam.elevation_sigma_mm(40.0);
  const auto shaft = shaft_to({45.0, 40.0, 0.0}, in_plane(0.5 * kPi), 90.0);
  for (const double diameter_mm : {0.5, 1.2, 3.0}) {
    NeedleEcho needle = needle_of(shaft);
    needle.diameter_mm = diameter_mm;
    needle.bore_share = 0.0;
    const double covered = std::erf(diameter_mm / (2.0 * std::numbers::sqrt2 * one_way_mm));
    EXPECT_NEAR(shadow_db(engine, needle, 65.0, 95.0), 2.0 * db(1.0 - kShadowShare * covered), 0.15) << diameter_mm;
    EXPECT_NEAR(shadow_db(engine, needle, 10.0, 35.0), 0.0, 0.05) << "nothing before it";
  }
}

TEST(NeedleEffects, ShadowOfACrossingNeedleFillsWithDepth) {
  BMode engine = engine_in(TestTissue::kLossless);
  const auto shaft = shaft_to({0.0, 30.0, 40.0}, Vec3::UnitZ(), 80.0);
  const NeedleEcho needle = needle_of(shaft);
  const double near_db = shadow_db(engine, needle, 45.0, 50.0), far_db = shadow_db(engine, needle, 90.0, 97.0);
  EXPECT_LT(near_db, -0.5);
  EXPECT_GT(far_db, near_db + 0.2);
  EXPECT_LT(far_db, 0.0);
}

TEST(NeedleEffects, MovesWithPressedTissue) {
  const ScenePtr scene = homogeneous_scene(box_for(default_convex(), 100.0, 2.0), TestTissue::kWater);
  BMode engine(scene, default_convex(), shallow());
  const auto shaft = shaft_to({40.0, 16.0, 0.0}, in_plane(0.5 * kPi), 80.0);
  const NeedleEcho needle = needle_of(shaft);
  BModeInput input;
  input.needles = {&needle, 1};
  constexpr double kPressed_mm = 8.0;
  input.X_PT = Pose::translation({0.0, kPressed_mm, 0.0});
  const double reach_mm = find_dent_reach_mm(*scene, engine.geometry(), input.X_PT);
  const double shown_mm = peak_of(engine.render(input), 64, 4.0, 30.0).depth_mm;
  EXPECT_NEAR(shown_mm, pressed_depth_mm(16.0 - kPressed_mm, kPressed_mm, reach_mm), 0.3);
  EXPECT_GT(shown_mm, 16.0 - kPressed_mm + 0.5);
}

TEST(NeedleEffects, DragsTissueNearTheTipOnly) {
  BMode engine = engine_in(TestTissue::kLossless);
  const Vec3 tip(0.0, 55.0, 0.0);
  const auto shaft = shaft_to(tip, in_plane(0.5 * kPi));
  NeedleEcho needle = needle_of(shaft);
  const BasebandFrame still = seen(engine, needle);
  needle.displacement_mm = 3.0;
  const BasebandFrame dragged = seen(engine, needle);
  const auto change = [&](double x_mm, double y_mm) {
    const Polar at = still.geometry.to_polar({x_mm, y_mm});
    double difference = 0.0, power = 0.0;
    for (int line = static_cast<int>(at.line) - 3; line <= static_cast<int>(at.line) + 3; ++line)
      for (int s = static_cast<int>(at.depth_mm / still.geometry.sample_mm()) - 8;
           s <= static_cast<int>(at.depth_mm / still.geometry.sample_mm()) + 8; ++s) {
        const auto n = static_cast<std::size_t>(line * still.geometry.samples + s);
        difference += std::pow(still.re[n] - dragged.re[n], 2) + std::pow(still.im[n] - dragged.im[n], 2);
        power += std::pow(still.re[n], 2) + std::pow(still.im[n], 2);
      }
    return difference / power;
  };
  EXPECT_GT(change(4.0, 55.0), 0.3);
  EXPECT_GT(change(2.0, 52.0), 0.3);
  EXPECT_LT(change(0.0, 80.0), 1e-3);
  EXPECT_LT(change(25.0, 40.0), 1e-3);
}

TEST(NeedleEffects, DragPointsAlongTheTip) {
  NeedleAlone engine;
  FrameState& frame = engine.frame;
  // The transducer looks along -x of P from x = 90: y of T is -x of P.
  Mat3 R;
  R << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  frame.X_PT = Pose(R, Vec3(90.0, 0.0, 0.0));
  const std::vector<Vec3> bent{Vec3(80.0, -60.0, 0.0), Vec3(40.0, -60.0, 0.0), Vec3(40.0, -10.0, 0.0)};
  NeedleEcho needle = needle_of(bent);
  needle.displacement_mm = -2.0;
  seen(engine, needle);
  EXPECT_NEAR((frame.drag.tip_T - Vec3f(-10.0F, 50.0F, 0.0F)).norm(), 0.0F, 1e-4F);
  EXPECT_NEAR((frame.drag.shift_T - Vec3f(-2.0F, 0.0F, 0.0F)).norm(), 0.0F, 1e-4F);
  engine.render({});
  EXPECT_EQ(frame.drag.reach_mm, 0.0F);
}

TEST(NeedleEffects, IgnoresInvalidNeedles) {
  BMode engine = engine_in(TestTissue::kLossless);
  const BasebandFrame none = seen(engine, {});
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kHuge = std::numeric_limits<double>::infinity();
  const Vec3 a(-20.0, 50.0, 0.0), b(20.0, 50.0, 0.0);
  const std::vector<std::vector<Vec3>> shafts{
      {}, {a}, {a, a, a}, {a, Vec3(kNan, 50.0, 0.0)}, {a, Vec3(0.0, kHuge, 0.0)}, {a, Vec3(0.0, 1e12, 0.0)}};
  for (const auto& shaft : shafts) {
    NeedleEcho needle = needle_of(shaft);
    needle.displacement_mm = 2.0;
    const BasebandFrame frame = seen(engine, needle);
    EXPECT_EQ(frame.re, none.re);
    EXPECT_EQ(frame.im, none.im);
  }
  const std::vector<Vec3> good{a, b};
  for (double NeedleEcho::*field :
       {&NeedleEcho::diameter_mm, &NeedleEcho::tip_mm, &NeedleEcho::displacement_mm, &NeedleEcho::bore_share}) {
    NeedleEcho needle = needle_of(good);
    needle.*field = kNan;
    EXPECT_EQ(seen(engine, needle).re, none.re);
    for (const double value : {-1e9, 0.0, 1e9}) {
      needle.*field = value;
      const BasebandFrame frame = seen(engine, needle);
      EXPECT_TRUE(std::all_of(frame.re.begin(), frame.re.end(), [](float v) { return std::isfinite(v); }));
    }
  }
}

TEST(NeedleEffects, AllocatesNothing) {
  NeedleAlone engine;
  const auto shaft = shaft_to({10.0, 70.0, 0.0}, in_plane(1.0));
  // More than are drawn.
  const std::vector<NeedleEcho> needles(NeedleImage::kMostNeedles + 3, needle_of(shaft));
  const AllocationGuard guard;
  lay_out_needles(engine.plan, engine.frame, needles, engine.image);
  for (int first = 0; first < engine.plan.lines; first += kGroup)
    add_needles(engine.plan, engine.frame, engine.image, first, first + kGroup);
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_EQ(engine.image.count, NeedleImage::kMostNeedles);
  EXPECT_GT(engine.image.parts[0].last_piece, 100U);
}

}  // namespace
}  // namespace trocar::ultrasound
