#pragma once

namespace trocar::ultrasound::detail {

inline constexpr double kMaxVoxels = 256e6;  ///< Of a volume; 2.5 GB during the reconstruction of a freehand sweep.

/// False for NaN.
constexpr bool is_within(double value, double low, double high) {
  return value >= low && value <= high;
}

}  // namespace trocar::ultrasound::detail
