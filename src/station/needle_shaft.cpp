#include "station/needle_shaft.h"

#include <algorithm>

namespace trocar {
namespace {

constexpr int kPoints = 17;

Mat3 device_rotation(const TickSample& sample) noexcept {
  const auto& [w, x, y, z] = sample.device_rotation_wxyz;
  const Eigen::Quaterniond q(w, x, y, z);
  return q.norm() > 0.0 ? q.normalized().toRotationMatrix() : Mat3(Mat3::Identity());
}

/// The device's rotation, turned the shortest way so that its `column` looks along the felt axis.
Mat3 felt_rotation(const TickSample& sample, int column) noexcept {
  const Mat3 R = device_rotation(sample);
  return sample.axis.norm() > 0.0 ? Mat3(rotation_between(R.col(column), sample.axis.normalized()) * R) : R;
}

}  // namespace

Pose device_pose(const TickSample& sample) noexcept {
  return {device_rotation(sample), sample.device_mm};
}

Pose felt_needle(const TickSample& sample) noexcept {
  return {felt_rotation(sample, 2), sample.tip_mm};
}

Pose felt_probe(const TickSample& sample) noexcept {
  return {felt_rotation(sample, 1), sample.tip_mm};
}

std::vector<Vec3> needle_shaft(const TickSample& sample, double length_mm) {
  const Vec3 grip_axis = device_rotation(sample).col(2);
  const Vec3 tip_axis = felt_needle(sample).R().col(2);
  const double lag_mm = (sample.device_mm - sample.tip_mm).dot(grip_axis);
  const Vec3 hub_P = sample.device_mm - (length_mm + lag_mm) * grip_axis;
  const Vec3 way_P = sample.tip_mm - hub_P;
  const double span_mm = way_P.norm();
  std::vector<Vec3> points;
  points.reserve(kPoints);
  double bend_mm = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double t = static_cast<double>(i) / (kPoints - 1);
    const double left = 1.0 - t;
    const Vec3 chord_P = hub_P + t * way_P;
    // Hermite: at the chord's length, bent by how the ends' directions differ from it.
    const Vec3 tangent_hub = span_mm * grip_axis - way_P, tangent_tip = span_mm * tip_axis - way_P;
    const Vec3 bend = t * left * (left * tangent_hub - t * tangent_tip);
    bend_mm = std::max(bend_mm, bend.norm());
    points.push_back(chord_P + bend);
  }
  if (bend_mm < kShaftBends_mm) return {hub_P, sample.tip_mm};
  points.back() = sample.tip_mm;
  return points;
}

}  // namespace trocar
