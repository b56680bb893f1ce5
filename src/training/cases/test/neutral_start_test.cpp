#include "cases/neutral_start.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/files/folders.h"
#include "volume/sampling.h"

namespace trocar::cases {
namespace {

constexpr double kAcross_mm = 150.0, kFrontBack_mm = 100.0;  ///< Half axes of the body.
constexpr double kArmAt_mm = 190.0, kArm_mm = 35.0;
constexpr double kHalfLength_mm = 120.0;

/// Signed, near enough to a distance: a body with two arms beside it, along z.
double outside_mm(const Vec3& p_P) {
  const double x = p_P.x() / kAcross_mm, y = p_P.y() / kFrontBack_mm;
  const double body = (std::hypot(x, y) - 1.0) * kFrontBack_mm;
  const double arm = std::hypot(std::abs(p_P.x()) - kArmAt_mm, p_P.y() - 20.0) - kArm_mm;
  return std::min(body, arm);
}

std::shared_ptr<const anatomy::VirtualPatient> cylinder() {
  static const auto made = [] {
    auto patient = std::make_shared<anatomy::VirtualPatient>();
    volume::GridGeometry grid;
    grid.spacing_mm = {5.0, 5.0, 5.0};
    grid.size = {101, 61, 2 * static_cast<std::int64_t>(kHalfLength_mm / 5.0) + 1};
    grid.origin_P = {-250.0, -150.0, -kHalfLength_mm};
    patient->skin_distance_mm = volume::FloatGrid(grid);
    patient->ct = volume::CtGrid(grid, 0);
    patient->labels = volume::LabelGrid(grid, 0);
    for (std::size_t n = 0; n < grid.voxel_count(); ++n) {
      const volume::Index3 i = grid.index_of(n);
      patient->skin_distance_mm.voxels[n] = static_cast<float>(outside_mm(grid.centre_mm(i)));
    }
    return patient;
  }();
  return made;
}

/// A plan that goes in at an angle (rad) from the front towards the patient's left.
Case case_at(double angle, double z_mm) {
  Case the_case;
  the_case.patient = cylinder();
  the_case.needle.length_mm = 150.0;
  const Vec3 entry_P(kAcross_mm * std::sin(angle), -kFrontBack_mm * std::cos(angle), z_mm);
  the_case.plan.line_P = {entry_P, 0.7 * entry_P};
  return the_case;
}

const ultrasound::Transducer& transducer() {
  static const ultrasound::Transducer probe = *ultrasound::load_transducer(data_dir() / "transducers.toml", "C5-2");
  return probe;
}

TEST(NeutralStart, KeepsAwayFromEveryPlan) {
  for (double angle = -1.9; angle <= 1.9; angle += 0.19) {
    for (const double z_mm : {-60.0, 0.0, 75.0}) {
      const Case the_case = case_at(angle, z_mm);
      const Segment& path_P = the_case.plan.line_P;
      const Pose X_PT_planned = Pose::translation(path_P.a + Vec3(0.0, 0.0, 35.0));
      const auto start = find_neutral_start(the_case, transducer(), X_PT_planned);
      ASSERT_TRUE(start) << start.error().text();
      EXPECT_EQ(start->note, "");
      const Vec3 tip_P = start->X_PN.p(), into_P = start->X_PN.R().col(2);
      const Vec3 skin_P = tip_P + NeutralStart::kAbove_mm * into_P;
      EXPECT_NEAR(outside_mm(skin_P), 0.0, 2.0);  // half a voxel
      EXPECT_GE((skin_P - path_P.a).norm(), NeutralStart::kAway_mm) << angle;
      EXPECT_GE((start->X_PT.p() - path_P.a).norm(), NeutralStart::kAway_mm - 15.0) << angle;  // pressed in and tilted
      EXPECT_GE((start->X_PT.p() - X_PT_planned.p()).norm(), NeutralStart::kAway_mm - 15.0) << angle;
      EXPECT_GE((start->X_PT.p() - skin_P).norm(), NeutralStart::kApart_mm) << angle;
      EXPECT_GT(distance_to_line_mm(tip_P, into_P, path_P.b), 20.0) << angle;
      EXPECT_GT(into_P.y(), 0.25);  // from the front, never from below
      for (double s_mm = 0.0; s_mm <= the_case.needle.length_mm; s_mm += 5.0)
        EXPECT_GT(outside_mm(tip_P - s_mm * into_P), 5.0) << angle;
      EXPECT_LT(std::abs(tip_P.z()), kHalfLength_mm);
    }
  }
}

TEST(NeutralStart, IsIndependentOfADistantPlan) {
  // From the flank the middle of the front is far enough: two different plans begin alike.
  const auto high = find_neutral_start(case_at(-0.9, 20.0), transducer(), Pose::translation({-120.0, -60.0, 60.0}));
  const auto low = find_neutral_start(case_at(-1.0, 20.0), transducer(), Pose::translation({-130.0, -50.0, 60.0}));
  ASSERT_TRUE(high && low);
  EXPECT_LT((high->X_PN.p() - low->X_PN.p()).norm(), 1e-9);
  EXPECT_LT((high->X_PT.p() - low->X_PT.p()).norm(), 1e-9);
}

TEST(NeutralStart, UsesTheSideOfTheEntry) {
  Case the_case = case_at(0.0, 0.0);
  Segment& path_P = the_case.plan.line_P;
  path_P = {-path_P.a, -path_P.b};  // of one who lies on his belly
  const auto start = find_neutral_start(the_case, transducer(), Pose::translation(path_P.a + Vec3(0.0, 0.0, 35.0)));
  ASSERT_TRUE(start);
  EXPECT_LT(start->X_PN.R()(1, 2), -0.25);
  EXPECT_GT(start->X_PT.p().y(), 0.0);
}

TEST(NeutralStart, StaysOutOfTheTasksEntryZone) {
  Case the_case = case_at(-1.2, 0.0);
  const auto free = find_neutral_start(the_case, transducer(), Pose::translation({-130.0, -40.0, 40.0}));
  ASSERT_TRUE(free);
  const Vec3 before_P = free->X_PN * Vec3(0.0, 0.0, NeutralStart::kAbove_mm);
  the_case.task.entry_zone = tasks::EntryZone{before_P, 30.0};
  const auto start = find_neutral_start(the_case, transducer(), Pose::translation({-130.0, -40.0, 40.0}));
  ASSERT_TRUE(start);
  EXPECT_GE((start->X_PN * Vec3(0.0, 0.0, NeutralStart::kAbove_mm) - before_P).norm(), 50.0 - 1e-6);
}

TEST(NeutralStart, FallsBackToThePlanForASmallPatient) {
  Case the_case = case_at(0.0, 0.0);
  auto small = std::make_shared<anatomy::VirtualPatient>(*the_case.patient);
  for (float& distance : small->skin_distance_mm.voxels) distance += 70.0F;  // 30 mm and thinner
  the_case.patient = small;
  the_case.plan.line_P = {{0.0, -30.0, 0.0}, {0.0, 0.0, 0.0}};
  volume::GridGeometry& grid = small->skin_distance_mm.geometry;
  grid.spacing_mm.z() = 1.2;  // and shorter than the tools need
  grid.origin_P.z() = -0.6 * static_cast<double>(grid.size[2]);
  const auto start = find_neutral_start(the_case, transducer(), Pose::translation({0.0, -30.0, 20.0}));
  ASSERT_TRUE(start);
  EXPECT_NE(start->note.find("begin at the planned position"), std::string::npos) << start->note;
  EXPECT_NEAR(distance_to_line_mm(the_case.plan.line_P.a, the_case.plan.line_P.direction(), start->X_PN.p()), 0.0,
              1e-9);
}

}  // namespace
}  // namespace trocar::cases
