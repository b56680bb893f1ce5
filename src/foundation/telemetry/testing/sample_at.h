#pragma once

#include "geometry/pose.h"
#include "telemetry/tick_sample.h"

namespace trocar::testing {

/// A tick whose device and virtual needle have one pose.
inline telemetry::TickSample sample_at(const Pose& X_PN) {
  telemetry::TickSample sample;
  sample.tip_mm = sample.device_mm = X_PN.p();
  sample.axis = X_PN.R().col(2);
  sample.device_rotation_wxyz = to_wxyz(Eigen::Quaterniond(X_PN.R()));
  return sample;
}

}  // namespace trocar::testing
