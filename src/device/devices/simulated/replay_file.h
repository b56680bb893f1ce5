#pragma once

#include <filesystem>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"

namespace trocar::devices {

/// A recorded motion of a stylus, for a replay device.
struct RecordedMotion {
  std::vector<Pose> poses;  ///< X_DS, one per period.
  double rate_hz = 1000.0;
};

/// Reads a motion from a CSV file: the header "time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz", then one pose X_DS per line at equal
/// steps in time. Errors name the line: a number is missing or not finite, a quaternion is zero, the steps are
/// uneven, or there are fewer than two poses.
Result<RecordedMotion> read_motion(const std::filesystem::path& path);

/// Writes `motion` to a file, completely or not at all. read_motion() returns bit-identical positions, and rotations
/// within 1e-15.
Status write_motion(const RecordedMotion& motion, const std::filesystem::path& path);

}  // namespace trocar::devices
