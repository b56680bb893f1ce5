#include "telemetry/tick_pose.h"

#include <algorithm>

#include "geometry/quaternion.h"

namespace trocar::telemetry {
namespace {

constexpr double kClear_mm = 0.1;  // in front of a layer, so that its place is not in it

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

bool is_in_body(const TickSample& sample) noexcept {
  const bool is_on_skin =
      sample.phase == InsertionPhase::kLoading && sample.depth_mm <= sample.layer_displacement_mm + kClear_mm;
  return sample.depth_mm > 0.0 && !is_on_skin;
}

Vec3 pierced_rest_tip_mm(const TickSample& sample) noexcept {
  const bool is_loading = sample.phase == InsertionPhase::kLoading && sample.layer_displacement_mm > 0.0;
  return is_loading ? Vec3(sample.rest_tip_mm - (sample.layer_displacement_mm + kClear_mm) * sample.rest_axis)
                    : sample.rest_tip_mm;
}

NeedlePlace needle_place(const TickSample& sample) noexcept {
  constexpr double kOblique = 3.0;  // a needle at 70 degrees to the skin's normal
  const Pose felt = felt_needle(sample);
  const double deep_mm = sample.layer_displacement_mm;
  const bool is_loading = sample.phase == InsertionPhase::kLoading;
  if (is_loading && !is_in_body(sample))  // on unpierced skin
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
