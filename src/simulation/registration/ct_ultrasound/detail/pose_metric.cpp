#include "registration/ct_ultrasound/detail/pose_metric.h"

#include <algorithm>
#include <cmath>

namespace trocar::registration::detail {
namespace {

constexpr int kBins = 32;  ///< Of each axis of the joint histogram.

MotionNumbers numbers_of(const Motion& motion) {
  MotionNumbers numbers;
  std::copy(motion.begin(), motion.end(), numbers.begin());
  return numbers;
}

}  // namespace

ImageView view_of(const volume::FloatGrid& grid) {
  ImageView view;
  view.voxels = grid.voxels.data();
  view.size = grid.geometry.size;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto row = static_cast<int>(a);
    view.spacing_mm[a] = grid.geometry.spacing_mm[row];
    view.origin_mm[a] = grid.geometry.origin_P[row];
    for (std::size_t b = 0; b < 3; ++b) view.direction[a][b] = grid.geometry.R_PV(row, static_cast<int>(b));
  }
  return view;
}

std::vector<std::array<double, 3>> numbers_of(std::span<const Vec3> points) {
  std::vector<std::array<double, 3>> numbers;
  numbers.reserve(points.size());
  for (const Vec3& p : points) numbers.push_back({p.x(), p.y(), p.z()});
  return numbers;
}

Pose pose_of(const Motion& motion, const Vec3& centre) {
  const Mat3 R = (Eigen::AngleAxisd(motion[2], Vec3::UnitZ()) * Eigen::AngleAxisd(motion[0], Vec3::UnitX()) *
                  Eigen::AngleAxisd(motion[1], Vec3::UnitY()))
                     .toRotationMatrix();
  return {R, centre + motion.tail<3>() - R * centre};
}

Motion motion_of(const Pose& pose, const Vec3& centre) {
  const Mat3& R = pose.R();  // Rz Rx Ry
  Motion motion;
  motion[0] = std::asin(std::clamp(R(2, 1), -1.0, 1.0));
  motion[1] = std::atan2(-R(2, 0), R(2, 2));
  motion[2] = std::atan2(-R(0, 1), R(1, 1));
  motion.tail<3>() = pose * centre - centre;
  return motion;
}

PoseMetric::PoseMetric(const Level& level, std::span<const Vec3> points, const Vec3& centre)
    : itk_(view_of(level.us), view_of(level.ct), numbers_of(points), {centre.x(), centre.y(), centre.z()}, kBins) {}

double PoseMetric::value(const Motion& motion) {
  return itk_.value(numbers_of(motion));
}

MattesItk::Slope PoseMetric::slope(const Motion& motion) {
  return itk_.value_and_gradient(numbers_of(motion));
}

Summit climb(PoseMetric& metric, const Motion& start, const ClimbOptions& options) {
  Motion mm_per_unit = Motion::Ones();
  mm_per_unit.head<3>().setConstant(options.radius_mm);
  Summit summit{start, 0.0};
  Motion motion = start;
  Motion last = Motion::Zero();
  double step_mm = options.step_mm;
  for (int n = 0; n < options.most_steps && step_mm > options.shortest_mm; ++n) {
    const MattesItk::Slope slope = metric.slope(motion);
    if (n == 0 || slope.value > summit.value) summit = {motion, slope.value};
    Motion uphill;
    for (int a = 0; a < 6; ++a) uphill[a] = slope.gradient[static_cast<std::size_t>(a)] / mm_per_unit[a];
    const double norm = uphill.norm();
    if (!(norm > 0.0)) break;
    uphill /= norm;
    if (uphill.dot(last) < 0.0) step_mm *= 0.5;
    last = uphill;
    motion += step_mm * uphill.cwiseQuotient(mm_per_unit);
  }
  return summit;
}

}  // namespace trocar::registration::detail
