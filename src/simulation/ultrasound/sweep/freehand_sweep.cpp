#include "ultrasound/sweep/freehand_sweep.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/result.h"
#include "ultrasound/scanner/scanner.h"
#include "ultrasound/sweep/mechanical_sweep.h"
#include "volume/sampling.h"

namespace trocar::ultrasound {
namespace {

/// A sensor on the transducer's handle, behind and beside the face. Assumed.
Pose sensor_pose_in_transducer() {
  return {Eigen::AngleAxisd(0.3, Vec3(1.0, 2.0, -1.0).normalized()).toRotationMatrix(), {12.0, -95.0, 20.0}};
}

/// A tracker at the side of the couch, above the patient. Assumed.
Pose patient_pose_in_tracker() {
  return {Eigen::AngleAxisd(2.1, Vec3(1.0, 0.3, 0.2).normalized()).toRotationMatrix(), {150.0, -60.0, -1100.0}};
}

TrackedSequence::Matrix4 matrix_of(const Pose& X) {
  TrackedSequence::Matrix4 matrix = TrackedSequence::Matrix4::Identity();
  matrix.topLeftCorner<3, 3>() = X.R();
  matrix.topRightCorner<3, 1>() = X.p();
  return matrix;
}

/// Maps (column, row, 0) of an image to points of T.
TrackedSequence::Matrix4 image_to_transducer(const RasterGeometry& raster) {
  TrackedSequence::Matrix4 matrix = TrackedSequence::Matrix4::Identity();
  matrix.diagonal().head<3>().setConstant(raster.mm_per_pixel);
  matrix(0, 3) = raster.first_T.x();
  matrix(1, 3) = raster.first_T.y();
  return matrix;
}

/// Moves along y of T until the centre of the face is at this depth; returns the pose itself if there is no such
/// position.
Pose follow_skin(const volume::FloatGrid& skin_distance_mm, const Pose& X_PT, double depth_of_face_mm) {
  constexpr double kFarthest_mm = 60.0;
  constexpr double kTolerance_mm = 0.05;
  constexpr int kMostSteps = 50;
  const Vec3 into_body_P = X_PT.R().col(1);
  double way_mm = 0.0;
  for (int step = 0; step < kMostSteps; ++step) {
    const double too_shallow_mm =
        volume::sample_linear(skin_distance_mm, Vec3(X_PT.p() + way_mm * into_body_P)) + depth_of_face_mm;
    if (std::abs(too_shallow_mm) < kTolerance_mm) return {X_PT.R(), X_PT.p() + way_mm * into_body_P};
    way_mm += too_shallow_mm;
    if (!(std::abs(way_mm) < kFarthest_mm)) break;  // also NaN
  }
  return X_PT;
}

/// -1/2..1/2.
double centred_share_of(int frame, int frames) {
  return static_cast<double>(frame) / (frames - 1) - 0.5;
}

}  // namespace

std::vector<Pose> slide_over_skin(const volume::FloatGrid& skin_distance_mm, const Pose& X_PT, double length_mm,
                                  int frames) {
  TROCAR_CHECK(frames >= 2);
  const double depth_of_face_mm = -volume::sample_linear(skin_distance_mm, X_PT.p());
  std::vector<Pose> poses;
  for (int n = 0; n < frames; ++n) {
    const Pose moved = X_PT * Pose::translation({0.0, 0.0, centred_share_of(n, frames) * length_mm});
    poses.push_back(follow_skin(skin_distance_mm, moved, depth_of_face_mm));
  }
  return poses;
}

std::vector<Pose> tilt_on_skin(const Pose& X_PT, double angle_rad, double radius_mm, int frames) {
  TROCAR_CHECK(frames >= 2);
  SweepGeometry swing;
  swing.radius_mm = radius_mm;
  swing.sweep_rad = angle_rad;
  swing.frames = frames;
  std::vector<Pose> poses;
  for (int n = 0; n < frames; ++n) poses.push_back(X_PT * swing.frame_pose(n));
  return poses;
}

Pose sway(const Pose& X_PT, int frame) noexcept {
  constexpr double kReach_mm = 3.8;
  constexpr double kTilt_rad = 0.05;
  const double phase = 0.11 * frame + 0.05;  // no frame is exactly at the nominal pose
  const double tilt_rad = kTilt_rad * std::sin(1.7 * phase);
  const double c = std::cos(tilt_rad), s = std::sin(tilt_rad);
  Mat3 R;
  R << 1, 0, 0, 0, c, -s, 0, s, c;
  return X_PT * Pose(R, {0.3 * kReach_mm * std::sin(2.3 * phase), 0.0, kReach_mm * std::sin(phase)});
}

FreehandSweep make_freehand_sweep(const std::shared_ptr<const AcousticScene>& scene, const Transducer& transducer,
                                  std::span<const Pose> X_PT, const FreehandSweepOptions& options,
                                  const Progress& progress) {
  BMode engine(scene, transducer, options.acquisition);
  Scanner scanner(options.columns, options.rows);
  scanner.settings = options.display;
  scanner.settings.is_mirrored = false;
  scanner.artefacts = options.acquisition.artefacts;

  const RasterGeometry raster = fit_raster(engine.geometry(), options.columns, options.rows);
  const Pose X_TProbe = sensor_pose_in_transducer();
  const Pose X_TrackerReference = patient_pose_in_tracker();
  const TrackedSequence::Matrix4 image_to_probe = matrix_of(X_TProbe.inverse()) * image_to_transducer(raster);

  FreehandSweep sweep{{}, 0.0};
  TrackedSequence& sequence = sweep.sequence;
  sequence.columns = options.columns;
  sequence.rows = options.rows;
  sequence.pixels.reserve(sequence.frame_pixels() * X_PT.size());
  for (std::size_t n = 0; n < X_PT.size(); ++n) {
    report(progress, "sweeping", static_cast<double>(n) / static_cast<double>(X_PT.size()));
    TrackedSequence::Frame frame;
    frame.time_s = static_cast<double>(n) / options.frames_per_s;
    const BasebandFrame& echoes = engine.render({X_PT[n], {}, frame.time_s});
    sweep.mean_contact += coupled_share(echoes) / static_cast<double>(X_PT.size());
    const image::GrayImage& picture = scanner.show(echoes, mix64(mix64(options.seed) ^ static_cast<std::uint64_t>(n)));
    sequence.pixels.insert(sequence.pixels.end(), picture.pixels.begin(), picture.pixels.end());
    frame.transforms.emplace("ImageToProbe", image_to_probe);
    frame.transforms.emplace("ProbeToTracker", matrix_of(X_TrackerReference * X_PT[n] * X_TProbe));
    frame.transforms.emplace("ReferenceToTracker", matrix_of(X_TrackerReference));
    sequence.frames.push_back(std::move(frame));
  }
  report(progress, "done", 1.0);
  return sweep;
}

}  // namespace trocar::ultrasound
