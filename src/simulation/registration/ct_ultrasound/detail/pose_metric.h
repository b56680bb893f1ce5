#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/pose.h"
#include "registration/ct_ultrasound/detail/mattes_itk.h"
#include "registration/ct_ultrasound/detail/working_images.h"

namespace trocar::registration::detail {

/// Small motion of the ultrasound: angles (rad) of ITK's Euler3DTransform about x, y, z through a centre, then a
/// translation (mm).
using Motion = Eigen::Matrix<double, 6, 1>;

ImageView view_of(const volume::FloatGrid& grid);
std::vector<std::array<double, 3>> numbers_of(std::span<const Vec3> points);

/// Pose of the moved ultrasound.
Pose pose_of(const Motion& motion, const Vec3& centre);
/// The motion of a pose; angles about y below a quarter turn.
Motion motion_of(const Pose& pose, const Vec3& centre);

/// Mutual information over motions about the centre of the usable voxels. Not for several threads at once.
class PoseMetric {
 public:
  PoseMetric(const Level& level, std::span<const Vec3> points, const Vec3& centre);
  double value(const Motion& motion);
  MattesItk::Slope slope(const Motion& motion);

 private:
  MattesItk itk_;
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
