#include "telemetry/tick_pose.h"

#include <algorithm>

#include "geometry/quaternion.h"

namespace trocar::telemetry {
namespace {

Mat3 device_rotation(const TickSample& sample) noexcept {
  const Eigen::Quaterniond q = from_wxyz(sample.device_rotation_wxyz);
  return q.norm() > 0.0 ? q.normalized().toRotationMatrix() : Mat3(Mat3::Identity());
}

/// The device's rotation, with the minimal rotation that aligns its `column` with the axis of the virtual needle.
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

NeedlePlace needle_place(const TickSample& sample) noexcept {
  constexpr double kClear_mm = 0.1;
  constexpr double kOblique = 3.0;  // a needle at 70 degrees to the skin's normal
  const Pose felt = felt_needle(sample);
  const double deep_mm = sample.layer_displacement_mm;
  const bool is_loading = sample.phase == InsertionPhase::kLoading;
  if (is_loading && sample.depth_mm <= deep_mm + kClear_mm)  // on unpierced skin
    return {felt * Pose::translation({0.0, 0.0, -kOblique * deep_mm - kClear_mm}), 0.0};
  if (sample.phase == InsertionPhase::kOutside) return {felt, 0.0};
  const double back_mm = is_loading ? deep_mm + kClear_mm : 0.0;
  const double ahead_mm = std::max(0.0, sample.axis.dot(sample.device_mm - sample.tip_mm));
  return {felt * Pose::translation({0.0, 0.0, -back_mm}), ahead_mm};
}

Pose felt_probe(const TickSample& sample) noexcept {
  return {felt_rotation(sample, 1), sample.tip_mm};
}

}  // namespace trocar::telemetry
