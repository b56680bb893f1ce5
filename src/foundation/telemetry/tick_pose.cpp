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

double pressed_mm(const TickSample& sample) noexcept {
  const bool is_inserted = sample.phase == InsertionPhase::kInserted || sample.phase == InsertionPhase::kRetracting ||
                           (sample.phase == InsertionPhase::kLoading && sample.contact_to_puncture_mm != Vec3::Zero());
  return is_inserted ? std::max(0.0, sample.axis.dot(sample.device_mm - sample.tip_mm)) : 0.0;
}

Pose felt_probe(const TickSample& sample) noexcept {
  return {felt_rotation(sample, 1), sample.tip_mm};
}

}  // namespace trocar::telemetry
