#pragma once

#include "geometry/pose.h"

namespace trocar::haptics {

/// Resolution of a device's sensors.
struct EncoderParams {
  double count_mm = 0.0295;   ///< One count of position. Range 0.0001..1; 0: exact.
  double count_rad = 4.0e-5;  ///< One count of an angle. Range 1e-6..0.1; 0: exact.
};

/// Quantised pose: position rounded to counts on every axis, the rotation vector likewise; the error is at most half a
/// count per axis. Real-time safe.
Pose quantise(const Pose& X_DS, const EncoderParams& encoder) noexcept;

}  // namespace trocar::haptics
