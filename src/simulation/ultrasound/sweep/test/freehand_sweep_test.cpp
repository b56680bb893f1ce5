#include "ultrasound/sweep/freehand_sweep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ultrasound/sweep/freehand.h"
#include "ultrasound/sweep/mechanical_sweep.h"
#include "ultrasound/test/sweep_lab.h"
#include "volume/sampling.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

FreehandVolume reconstruct_poses(const std::vector<Pose>& poses, double spacing_mm) {
  FreehandSweepOptions options;
  options.acquisition = lab_options().acquisition;
  options.columns = 320;
  options.rows = 240;
  const TrackedSequence sequence = make_freehand_sweep(lab_scene(), motor_probe(), poses, options).sequence;
  FreehandOptions how;
  how.spacing_mm = Vec3::Constant(spacing_mm);
  how.interpolation = FreehandInterpolation::kLinear;
  how.is_black_left_out = true;
  how.holes = {HoleFilling{}};
  auto volume = reconstruct_freehand(sequence, {}, how);
  EXPECT_TRUE(volume);
  return volume ? *std::move(volume) : FreehandVolume{};
}

TEST(FreehandSweep, TiltReconstructsTheMotorVolume) {
  MechanicalSweepOptions options = lab_options();
  options.step_rad = 0.008;  // no holes between the frames
  const auto direct = make_mechanical_sweep(lab_scene(), motor_probe(), {}, options);
  ASSERT_TRUE(direct) << direct.error().text();
  const auto poses = tilt_on_skin({}, options.sweep_rad, motor_probe().sweep_radius_mm, direct->geometry.frames);
  const FreehandVolume hand = reconstruct_poses(poses, options.spacing_mm);
  std::vector<std::uint8_t> resampled(direct->gray.voxels.size());
  for (std::size_t n = 0; n < resampled.size(); ++n) {
    const volume::Index3 ijk = direct->gray.geometry.index_of(n);
    const Vec3 p_P = direct->gray.geometry.centre_mm(ijk);
    resampled[n] = static_cast<std::uint8_t>(
        std::lround(volume::sample_linear_at_index(hand.gray, hand.gray.geometry.to_index(p_P))));
  }
  // Both interpolate the same frames, one by their scanlines and one by their pixels, on other grids.
  EXPECT_GT(volume::correlation(direct->gray.voxels, resampled, volume::ComparedVoxels::kBothAboveZero), 0.9);
}

TEST(FreehandSweep, SlideReconstructsPointsAtTheirPositions) {
  volume::FloatGrid flat_skin = lab_scene()->skin_distance_mm;
  const FreehandVolume volume = reconstruct_poses(slide_over_skin(flat_skin, {}, 50.0, 51), 0.7);
  for (const AcousticPoint& point : lab_points())
    EXPECT_LT((brightest_near(volume.gray, point.p_P) - point.p_P).norm(), kPlace_mm) << point.p_P.transpose();
}

TEST(FreehandSweep, SlideKeepsItsPressureOnCurvedSkin) {
  // A leg along x with a radius of 80 mm: the skin falls back to both sides in z.
  volume::GridGeometry geometry;
  geometry.size = {41, 101, 101};
  geometry.spacing_mm = Vec3::Constant(2.0);
  geometry.origin_P = {-40.0, -20.0, -100.0};
  volume::FloatGrid skin(geometry);
  constexpr double kRadius_mm = 80.0;
  for (std::size_t n = 0; n < geometry.voxel_count(); ++n) {
    const volume::Index3 ijk = geometry.index_of(n);
    const Vec3 p = geometry.centre_mm(ijk);
    skin.voxels[n] = static_cast<float>(std::hypot(p.y() - kRadius_mm, p.z()) - kRadius_mm);
  }
  const Pose X_PT = Pose::translation({0.0, 4.0, 0.0});  // pressed in by 4 mm
  const auto poses = slide_over_skin(skin, X_PT, 80.0, 9);
  ASSERT_EQ(poses.size(), 9U);
  for (std::size_t n = 0; n < poses.size(); ++n) {
    const Vec3 p = poses[n].p();
    EXPECT_NEAR(p.z(), -40.0 + 10.0 * static_cast<double>(n), 1e-9);
    EXPECT_NEAR(kRadius_mm - std::hypot(p.y() - kRadius_mm, p.z()), 4.0, 0.1) << p.transpose();
    EXPECT_EQ(poses[n].R(), Mat3::Identity());
  }
}

TEST(FreehandSweep, ASlideBesideTheBodyStaysStraight) {
  volume::GridGeometry geometry;
  geometry.size = {4, 4, 4};
  const volume::FloatGrid nowhere(geometry, 500.0F);
  const auto poses = slide_over_skin(nowhere, {}, 20.0, 3);
  for (const Pose& pose : poses) EXPECT_TRUE(pose.is_finite());
}

TEST(FreehandSweep, StillHandNeverRepeatsAPosition) {
  const Pose X_PT = Pose::translation({5.0, 6.0, 7.0});
  std::vector<Vec3> places{X_PT.p()};
  for (int n = 0; n < 300; ++n) {
    const Vec3 p = sway(X_PT, n).p();
    EXPECT_LT((p - X_PT.p()).norm(), 4.0);
    for (const Vec3& other : places) EXPECT_GT((p - other).norm(), 1e-4);
    places.push_back(p);
  }
}

TEST(FreehandSweep, FramesStorePoseAndTimeLikePlus) {
  FreehandSweepOptions options;
  options.acquisition = lab_options().acquisition;
  options.columns = 64;
  options.rows = 48;
  const std::vector<Pose> poses = tilt_on_skin({}, 0.2, 0.0, 3);
  const TrackedSequence sequence = make_freehand_sweep(lab_scene(), motor_probe(), poses, options).sequence;
  ASSERT_EQ(sequence.frames.size(), 3U);
  EXPECT_EQ(sequence.pixels.size(), 3U * 64U * 48U);
  const RasterGeometry raster = fit_raster(make_scan_geometry(motor_probe(), options.acquisition.depth_mm,
                                                              options.acquisition.lines, options.acquisition.samples),
                                           64, 48);
  for (std::size_t n = 0; n < 3; ++n) {
    const auto& frame = sequence.frames[n];
    EXPECT_NEAR(frame.time_s, 0.05 * static_cast<double>(n), 1e-12);
    const TrackedSequence::Matrix4 image_to_patient = frame.transforms.at("ReferenceToTracker").inverse() *
                                                      frame.transforms.at("ProbeToTracker") *
                                                      frame.transforms.at("ImageToProbe");
    const Eigen::Vector4d p_P = image_to_patient * Eigen::Vector4d(20.0, 30.0, 0.0, 1.0);
    const Vec2 p_T = raster.to_T(20.0, 30.0);
    EXPECT_LT((p_P.head<3>() - poses[n] * Vec3(p_T.x(), p_T.y(), 0.0)).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace trocar::ultrasound
