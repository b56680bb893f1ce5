#include "ultrasound/sweep/mechanical_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "ultrasound/test/sweep_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

SweepGeometry geometry() {
  SweepGeometry sweep;
  sweep.scan = make_scan_geometry(motor_probe(), 100.0, 128, 256);
  sweep.radius_mm = motor_probe().sweep_radius_mm;
  sweep.sweep_rad = 1.2;
  sweep.frames = 61;
  return sweep;
}

TEST(SweepGeometry, SamplesAndPointsAreExactInverses) {
  const SweepGeometry sweep = geometry();
  Random random(3);
  for (int n = 0; n < 2000; ++n) {
    const SweepGeometry::Place place{random.uniform(0.0, 60.0),
                                     {random.uniform(0.0, 127.0), random.uniform(0.0, 100.0)}};
    const SweepGeometry::Place back = sweep.to_place(sweep.to_cartesian(place));
    EXPECT_NEAR(back.frame, place.frame, 1e-9);
    EXPECT_NEAR(back.polar.line, place.polar.line, 1e-9);
    EXPECT_NEAR(back.polar.depth_mm, place.polar.depth_mm, 1e-9);
  }
}

TEST(SweepGeometry, SwingsAboutAnAxisBehindTheFace) {
  const SweepGeometry sweep = geometry();
  const Vec3 axis_T(5.0, -sweep.radius_mm, 0.0);
  for (const double frame : {0.0, 17.3, 60.0}) EXPECT_LT((sweep.frame_pose(frame) * axis_T - axis_T).norm(), 1e-12);
  // The middle frame is T itself; later ones look to +z, the outermost by half the angle.
  EXPECT_LT((sweep.frame_pose(30.0).R() - Mat3::Identity()).norm(), 1e-12);
  EXPECT_NEAR(sweep.frame_pose(60.0).R().col(1).z(), std::sin(0.6), 1e-12);
  EXPECT_NEAR(sweep.frame_pose(60.0).R().determinant(), 1.0, 1e-12);
}

TEST(SweepGeometry, ExtentIsTheTightestBoxOfAllSamples) {
  const SweepGeometry sweep = geometry();
  Vec3 first = Vec3::Constant(1e9), last = Vec3::Constant(-1e9);
  for (double frame = 0.0; frame <= 60.0; frame += 1.0)
    for (double line = 0.0; line <= 127.0; line += 1.0)
      for (const double depth_mm : {0.0, 100.0}) {
        const Vec3 p_T = sweep.to_cartesian({frame, {line, depth_mm}});
        first = first.cwiseMin(p_T);
        last = last.cwiseMax(p_T);
      }
  const SweepGeometry::Extent extent = sweep.extent();
  // No scanline points straight ahead: the bottom of the fan is met to a few hundredths.
  EXPECT_LT((extent.first_T - first).norm(), 0.05);
  EXPECT_LT((extent.last_T - last).norm(), 0.05);
}

const Result<SweepVolume>& lab_volume() {
  static const Result<SweepVolume> volume = make_mechanical_sweep(lab_scene(), motor_probe(), {}, lab_options());
  return volume;
}

TEST(MechanicalSweep, ShowsPointsAtTheirPositions) {
  const auto& volume = lab_volume();
  ASSERT_TRUE(volume) << volume.error().text();
  for (const AcousticPoint& point : lab_points())
    EXPECT_LT((brightest_near(volume->gray, point.p_P) - point.p_P).norm(), kPlace_mm) << point.p_P.transpose();
}

TEST(MechanicalSweep, FollowsTheTransducerPose) {
  const Pose X_PT(rotation_between(Vec3::UnitZ(), Vec3(0.2, -0.5, 0.7).normalized()), {10.0, -20.0, 30.0});
  const auto volume = make_mechanical_sweep(moved(*lab_scene(), X_PT), motor_probe(), X_PT, lab_options());
  ASSERT_TRUE(volume) << volume.error().text();
  const volume::LabelGrid placed = in_patient(*volume, X_PT);
  for (const AcousticPoint& point : lab_points()) {
    const Vec3 p_P = X_PT * point.p_P;
    EXPECT_LT((brightest_near(placed, p_P) - p_P).norm(), kPlace_mm);
  }
}

TEST(MechanicalSweep, SpeckleDependsOnTheTissueAndNoiseOnTheSeed) {
  MechanicalSweepOptions options = lab_options();
  options.acquisition.artefacts.noise = true;
  const auto first = make_mechanical_sweep(lab_scene(), motor_probe(), {}, options);
  const auto same = make_mechanical_sweep(lab_scene(), motor_probe(), {}, options);
  options.seed = 2;
  const auto other = make_mechanical_sweep(lab_scene(), motor_probe(), {}, options);
  ASSERT_TRUE(first && same && other);
  EXPECT_EQ(first->gray.voxels, same->gray.voxels);
  EXPECT_NE(first->gray.voxels, other->gray.voxels);
  EXPECT_GT(volume::correlation(first->gray.voxels, other->gray.voxels, volume::ComparedVoxels::kBothAboveZero), 0.95);
}

TEST(MechanicalSweep, IsBlackBesideTheFan) {
  const auto& volume = lab_volume();
  ASSERT_TRUE(volume);
  const volume::GridGeometry& grid = volume->gray.geometry;
  std::size_t inside = 0, lit = 0;
  for (std::size_t n = 0; n < grid.voxel_count(); ++n) {
    const volume::Index3 ijk = grid.index_of(n);
    const Vec3 p_T = grid.centre_mm(ijk);
    const SweepGeometry::Place place = volume->geometry.to_place(p_T);
    const double depth_mm = place.polar.depth_mm;
    const int frames = volume->geometry.frames, lines = volume->geometry.scan.lines;
    if (place.frame < -0.5 || place.frame > frames - 0.5 || place.polar.line < -0.5 || place.polar.line > lines - 0.5 ||
        depth_mm < 0.0 || depth_mm > volume->geometry.scan.depth_mm) {
      EXPECT_EQ(volume->gray.voxels[n], 0);
      continue;
    }
    ++inside;
    lit += volume->gray.voxels[n] > 0 ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(lit), 0.8 * static_cast<double>(inside));
}

TEST(MechanicalSweep, RefusesImpossibleOptions) {
  const auto refused = [](const Transducer& transducer, const MechanicalSweepOptions& options) {
    const auto volume = make_mechanical_sweep(lab_scene(), transducer, {}, options);
    return !volume && volume.error().exit_status == 2;
  };
  Transducer still = motor_probe();
  still.kind = TransducerKind::kConvex;
  EXPECT_TRUE(refused(still, lab_options()));
  for (const double sweep_rad : {-0.1, 1e-4, 2.0, std::nan("")}) {
    MechanicalSweepOptions options = lab_options();
    options.sweep_rad = sweep_rad;
    EXPECT_TRUE(refused(motor_probe(), options)) << sweep_rad;
  }
  for (const double step_rad : {0.0, -0.1, 1e-6, std::nan("")}) {
    MechanicalSweepOptions options = lab_options();
    options.step_rad = step_rad;
    EXPECT_TRUE(refused(motor_probe(), options)) << step_rad;
  }
  for (const double spacing_mm : {0.0, 0.1, 9.0, std::nan("")}) {
    MechanicalSweepOptions options = lab_options();
    options.spacing_mm = spacing_mm;
    EXPECT_TRUE(refused(motor_probe(), options)) << spacing_mm;
  }
}

}  // namespace
}  // namespace trocar::ultrasound
