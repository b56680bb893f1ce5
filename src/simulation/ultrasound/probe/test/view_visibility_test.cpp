#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/files/folders.h"
#include "ultrasound/probe/probe_placement.h"
#include "ultrasound/probe/probe_view.h"
#include "ultrasound/tissue/test/make_block.h"

namespace trocar::ultrasound {
namespace {

using testing::BlockVoxel;

constexpr double kBallDepth_mm = 50.0, kBallRadius_mm = 12.0;

Transducer shipped_convex() {
  return *load_transducer(data_dir() / "transducers.toml", "C5-2");
}

/// From the front, straight down to the ball.
ProbeView ball_view() {
  ProbeView view;
  view.name = "ball";
  view.targets = {"the kidney"};
  view.direction_P = {0.0, -1.0, 0.0};
  view.search_mm = 12.0;
  view.depth_mm = 130.0;
  view.frequency_mhz = 3.0;
  return view;
}

/// A ball in liver, behind what `cover` puts before it.
template <class Cover>
anatomy::VirtualPatient ball_behind(const Cover& cover) {
  return testing::make_block({240.0, 130.0, 240.0}, {4.0, 4.0, 4.0}, [&](const Vec3& p_P) -> BlockVoxel {
    if (const BlockVoxel covering = cover(p_P); covering.label != 0) return covering;
    const bool is_ball = (p_P - Vec3(0.0, kBallDepth_mm, 0.0)).norm() < kBallRadius_mm;
    return {is_ball ? testing::kKidney : testing::kLiver, 60};
  });
}

BlockVoxel nothing(const Vec3&) {
  return {};
}
/// A plate of bone, half_mm to each side of the way straight down, and endless along z.
auto plate(double half_mm) {
  return [half_mm](const Vec3& p_P) -> BlockVoxel {
    const bool is_plate = std::abs(p_P.x()) < half_mm && p_P.y() > 8.0 && p_P.y() < 18.0;
    return is_plate ? BlockVoxel{testing::kBone, 700} : BlockVoxel{};
  };
}

double sum_of(const ViewVisibility& v) {
  return v.visible + v.behind_bone + v.behind_gas + v.unscanned + v.outside_picture + v.too_deep;
}

TEST(ViewVisibility, IsOneForAnUnobstructedBall) {
  const anatomy::VirtualPatient patient = ball_behind(nothing);
  const auto placed = place_probe(patient, ball_view(), shipped_convex());
  ASSERT_TRUE(placed) << placed.error().text();
  EXPECT_NEAR(placed->visibility.visible, 1.0, 0.02);
  EXPECT_NEAR(sum_of(placed->visibility), 1.0, 1e-9);
  EXPECT_LT((placed->X_PT.p() - Vec3(0.0, 5.0, 0.0)).norm(), 4.0) << "straight above it";
  EXPECT_EQ(hidden_causes(ViewVisibility{.visible = 1.0}), "");
}

TEST(ViewVisibility, FindsAWindowBesideBone) {
  const anatomy::VirtualPatient patient = ball_behind(plate(24.0));
  const auto placed = place_probe(patient, ball_view(), shipped_convex());
  ASSERT_TRUE(placed) << placed.error().text();
  EXPECT_GT(placed->visibility.visible, 0.9) << hidden_causes(placed->visibility);
  EXPECT_NEAR(std::abs(placed->X_PT.p().y()), 5.0, 6.0) << "still on the skin";
  const auto measured = measure_visibility(patient, ball_view(), shipped_convex(), placed->X_PT);
  ASSERT_TRUE(measured);
  EXPECT_EQ(measured->visible, placed->visibility.visible);
}

TEST(ViewVisibility, ReportsWhatHidesTheTarget) {
  ProbeView fixed = ball_view();
  fixed.search_mm = 0.0;
  const auto behind = place_probe(ball_behind(plate(60.0)), fixed, shipped_convex());
  ASSERT_TRUE(behind);
  EXPECT_LT(behind->visibility.visible, 0.02);
  EXPECT_GT(behind->visibility.behind_bone, 0.95);
  EXPECT_NE(hidden_causes(behind->visibility).find("% behind bone"), std::string::npos);

  const auto gas = place_probe(ball_behind([](const Vec3& p_P) -> BlockVoxel {
                                 const bool is_bowel = p_P.y() > 10.0 && p_P.y() < 30.0 && p_P.z() < 0.0;
                                 return is_bowel ? BlockVoxel{testing::kBowel, -700} : BlockVoxel{};
                               }),
                               fixed, shipped_convex());
  ASSERT_TRUE(gas);
  EXPECT_NEAR(gas->visibility.behind_gas, 0.5, 0.15);
  EXPECT_NEAR(sum_of(gas->visibility), 1.0, 1e-9);
}

TEST(ViewVisibility, IsLimitedByImageAndPenetrationDepth) {
  const anatomy::VirtualPatient patient = ball_behind(nothing);
  ProbeView fixed = ball_view();
  fixed.search_mm = 0.0;
  fixed.depth_mm = kBallDepth_mm;
  const auto cut = place_probe(patient, fixed, shipped_convex());
  ASSERT_TRUE(cut);
  // The picture ends below the ball's middle, as the face is pressed in: a segment of the disc is left out.
  const double middle_mm = cut->X_PT.p().y();
  const double angle = std::acos(middle_mm / kBallRadius_mm);
  const double segment = (angle - std::sin(angle) * std::cos(angle)) / std::numbers::pi;
  EXPECT_GT(segment, 0.05);
  // Voxels of 4 mm and samples 3 mm apart: a row of samples more or less is an eighth of the disc.
  EXPECT_NEAR(cut->visibility.outside_picture, segment, 0.12);
  EXPECT_GT(cut->visibility.outside_picture, 0.05);
  Transducer shrill = shipped_convex();
  shrill.highest_mhz = 20.0;
  fixed = ball_view();
  fixed.search_mm = 0.0;
  fixed.frequency_mhz = 18.0;  // 63 dB of loss within 35 mm
  const auto deep = place_probe(patient, fixed, shrill);
  ASSERT_TRUE(deep);
  EXPECT_GT(deep->visibility.too_deep, 0.9);
}

TEST(ViewVisibility, CountsTheUnscannedPart) {
  // Half of the ball lies beyond the end of the CT at z = 0.
  anatomy::VirtualPatient patient = ball_behind(nothing);
  volume::GridGeometry half = patient.labels.geometry;
  const std::size_t slices = static_cast<std::size_t>(half.size[2]) / 2;
  const std::size_t slice = static_cast<std::size_t>(half.size[0] * half.size[1]);
  half.size[2] = static_cast<std::int64_t>(slices);
  patient.labels.geometry = patient.ct.geometry = patient.skin_distance_mm.geometry = half;
  patient.labels.voxels.resize(slices * slice);
  patient.ct.voxels.resize(slices * slice);
  patient.skin_distance_mm.voxels.resize(slices * slice);
  const Pose straight = [] {
    Mat3 R_PT;  // x to the head, y into the body
    R_PT << 0, 0, -1, 0, 1, 0, 1, 0, 0;
    return Pose(R_PT, {0.0, 5.0, 0.0});
  }();
  const auto seen = measure_visibility(patient, ball_view(), shipped_convex(), straight);
  ASSERT_TRUE(seen) << seen.error().text();
  EXPECT_NEAR(seen->unscanned, 0.5, 0.12);
  EXPECT_NEAR(seen->visible, 0.5, 0.12);
}

}  // namespace
}  // namespace trocar::ultrasound
