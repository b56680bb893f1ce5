#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/pose.h"
#include "registration/ct_ultrasound/detail/sampled_information.h"
#include "registration/ct_ultrasound/detail/working_images.h"

namespace trocar::registration::detail {

/// Small motion of the ultrasound: angles (rad) about x, y, z through a centre, R = Rz Rx Ry, then a translation (mm).
using Motion = Eigen::Matrix<double, 6, 1>;

/// Pose of the moved ultrasound.
Pose pose_of(const Motion& motion, const Vec3& centre);
/// The motion of a pose; angles about y below a quarter turn.
Motion motion_of(const Pose& pose, const Vec3& centre);

/// Mutual information over motions about a centre (docs/physics.md R12). Samples outside of the CT do not count. Keeps
/// a reference to the level. Bitwise independent of the number of threads. Not for several threads at once.
class PoseMetric {
 public:
  PoseMetric(const Level& level, std::span<const Vec3> points, const Vec3& centre);
  /// Nats.
  double value(const Motion& motion);
  struct Slope {
    double value = 0.0;
    Motion gradient = Motion::Zero();  ///< Of the value, per rad and per mm.
  };
  Slope slope(const Motion& motion);

 private:
  const volume::FloatGrid& ct_;
  Vec3 centre_;
  std::vector<Vec3> points_;  ///< From the centre.
  SampledInformation information_;
  std::vector<double> values_, slopes_;
  std::vector<Vec3f> gradients_;  ///< Of the CT's contrast, per voxel along its axes.
};

struct ClimbOptions {
  double radius_mm = 50.0;   ///< Rotations are scaled by it, so that a unit step moves the samples by about 1 mm.
  double step_mm = 4.0;      ///< First step.
  double shortest_mm = 0.3;  ///< Ends the climb.
  int most_steps = 60;
};
struct Summit {
  Motion motion = Motion::Zero();
  double value = 0.0;
};
/// Gradient ascent with steps of constant length, halved when the direction turns back (docs/physics.md R12).
Summit climb(PoseMetric& metric, const Motion& start, const ClimbOptions& options);

}  // namespace trocar::registration::detail
