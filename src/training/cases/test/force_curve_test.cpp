#include "cases/force_curve.h"

#include <gtest/gtest.h>

#include "haptics/test/layered_patient.h"

namespace trocar::cases {
namespace {

using testing::layered_patient;
using testing::liver_way;
using testing::paper_tissues;

constexpr double kDt_s = 0.001;
constexpr double kFluctuation_n = 0.05;  // of the friction

std::shared_ptr<const haptics::HapticScene> weightless_scene() {
  haptics::HapticOptions options;
  options.has_weight_compensation = false;
  auto scene = haptics::make_haptic_scene(layered_patient(liver_way()), paper_tissues(), {}, {}, options);
  TROCAR_CHECK(scene.has_value());
  return *scene;
}

PrescribedMotion straight_in() {
  PrescribedMotion motion;
  motion.line_P = {{0.0, 0.0, 0.0}, {0.0, 0.0, 40.0}};
  motion.speed_mm_per_s = 5.0;
  return motion;
}

TEST(ForceCurve, FindsTheLayersInOrderWithTheirDrops) {
  const auto events = find_curve_events(force_curve(*weightless_scene(), straight_in()), paper_tissues());
  ASSERT_EQ(events.size(), 3U);
  const std::vector<std::string> names{"skin", "muscle", "liver_capsule"};
  const std::vector<double> puncture_n{2.8, 2.5, 1.5};
  const std::vector<double> surface_mm{0.0, 12.0, 24.0};
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].layer, names[i]);
    EXPECT_GT(events[i].peak_n, puncture_n[i] - kFluctuation_n);  // friction of the shaft comes on top
    EXPECT_LT(events[i].peak_n, puncture_n[i] + 0.8);
    EXPECT_GT(events[i].way_mm, surface_mm[i]);         // tissue and coupling yield first ...
    EXPECT_LT(events[i].way_mm, surface_mm[i] + 6.0);   // ... by x and F/k
    EXPECT_NEAR(events[i].tip_mm, surface_mm[i], 1.0);  // the layer holds the tip
    EXPECT_GT(events[i].drop_n(), 0.25 * puncture_n[i]);
    EXPECT_GT(events[i].fall_ms, 0.0);
    EXPECT_LE(events[i].fall_ms, 1e3 * kAfter_s);
  }
}

TEST(ForceCurve, ContinuesUntilTheTipArrives) {
  PrescribedMotion motion = straight_in();
  const auto shorter = force_curve(*weightless_scene(), motion);
  EXPECT_LT(shorter.back().tip_mm, 40.0);  // the coupling's spring is stretched by the force in the liver
  motion.after_mm = 10.0;
  const auto longer = force_curve(*weightless_scene(), motion);
  EXPECT_NEAR(longer.back().tip_mm, 40.0, 0.05);
  EXPECT_LT(longer.back().way_mm, 43.0);
  ASSERT_GT(longer.size(), shorter.size());
  for (std::size_t i = 0; i < shorter.size(); ++i) EXPECT_EQ(shorter[i].force_n, longer[i].force_n);
}

TEST(ForceCurve, MeasuresPeakDropAndTimeOfAKnownCurve) {
  // 4 N until the layer gives way, then 0.1 N less a tick down to 1 N, then a slow rise.
  std::vector<CurvePoint> curve;
  for (int i = 0; i < 400; ++i) {
    CurvePoint point;
    point.time_s = kDt_s * i;
    point.way_mm = 0.01 * i;
    point.force_n = i <= 100 ? 0.04 * i : std::max(1.0, 4.0 - 0.1 * (i - 100)) + 0.001 * std::max(0, i - 130);
    curve.push_back(point);
  }
  curve[101].layer = 1;  // named a tick late
  const auto events = find_curve_events(curve, paper_tissues());
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].layer, "muscle");
  EXPECT_NEAR(events[0].way_mm, 1.0, 1e-9);
  EXPECT_NEAR(events[0].peak_n, 4.0, 1e-9);
  EXPECT_NEAR(events[0].after_n, 1.0, 1e-9);
  EXPECT_NEAR(events[0].fall_ms, 27.0, 1.0 + 1e-6);
}

TEST(ForceCurve, HasNoDropIfTheForceKeepsRising) {
  std::vector<CurvePoint> curve(50);
  for (std::size_t i = 0; i < curve.size(); ++i) curve[i].force_n = curve[i].time_s = kDt_s * static_cast<double>(i);
  curve[20].layer = 0;
  const auto events = find_curve_events(curve, paper_tissues());
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].drop_n(), 0.0);
  EXPECT_EQ(events[0].fall_ms, 0.0);
}

TEST(PiecesAlong, NamesTheLabelsBelowTheSkinShell) {
  const auto scene = weightless_scene();
  const auto pieces = pieces_along(*scene, paper_tissues(), straight_in().line_P);
  ASSERT_EQ(pieces.size(), 4U);
  constexpr double kStep_mm = 0.1;
  const std::vector<std::string> names{"skin", "fat", "muscle", "liver"};
  const std::vector<double> from{0.0, 2.0, 11.5, 23.5};  // labels are 1 mm voxels about their centres
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    EXPECT_EQ(pieces[i].name, names[i]);
    EXPECT_NEAR(pieces[i].from_mm, from[i], kStep_mm);
  }
  EXPECT_NEAR(pieces.back().to_mm, 40.0, kStep_mm);
  EXPECT_EQ(pieces[1].tissue, "adipose");
}

}  // namespace
}  // namespace trocar::cases
