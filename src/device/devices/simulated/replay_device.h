#pragma once

#include <filesystem>
#include <vector>

#include "core/result.h"
#include "devices/haptic_device.h"
#include "geometry/pose.h"

namespace trocar::devices {

/// A recorded hand: replays poses X_DS at a fixed rate, starting at the first read. Poses are interpolated, and
/// constant after the last one. Written wrenches are ignored. Real-time safe after construction.
class ReplayDevice final : public HapticDevice {
 public:
  ReplayDevice(stylus::DevicePreset preset, std::string name, std::vector<Pose> poses, double rate_hz);

  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return "replay:" + name_; }
  DeviceReading read(double now_s) noexcept override;
  /// Ignores the wrench. Returns false for an invalid wrench.
  bool write(const Wrench& wrench_D) noexcept override;
  bool is_in_real_hand() const noexcept override { return false; }
  Status reconnect() override { return {}; }

 private:
  stylus::DevicePreset preset_;
  std::string name_;
  std::vector<Pose> poses_;
  double rate_hz_;
  double start_s_ = 0.0;
  double last_s_ = 0.0;
  bool is_started_ = false;
};

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
