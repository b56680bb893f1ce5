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
/// steps in time. Errors name the line: a number that is missing or not finite, a quaternion without length, uneven
/// steps, fewer than two poses.
Result<RecordedMotion> read_motion(const std::filesystem::path& path);

/// Writes it; read_motion() gives the same positions to the bit, and rotations to 1e-15. Whole or not at all.
Status write_motion(const RecordedMotion& motion, const std::filesystem::path& path);

}  // namespace trocar::devices
