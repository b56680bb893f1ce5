#pragma once

#include <vector>

#include "devices/haptic_device.h"

namespace trocar::devices {

/// A recorded hand: replays poses X_DS at a fixed rate, starting at the first read. Poses are interpolated, and
/// constant after the last one. Written wrenches are ignored. Real-time safe after construction.
class ReplayDevice final : public HapticDevice {
 public:
  ReplayDevice(haptics::DevicePreset preset, std::string name, std::vector<Pose> poses, double rate_hz);

  const haptics::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return "replay:" + name_; }
  DeviceReading read(double now_s) noexcept override;
  /// Ignores the wrench. Returns false for an invalid wrench.
  bool write(const Wrench& wrench_D) noexcept override;
  bool is_in_real_hand() const noexcept override { return false; }
  Status reconnect() override { return {}; }

 private:
  haptics::DevicePreset preset_;
  std::string name_;
  std::vector<Pose> poses_;
  double rate_hz_;
  double start_s_ = 0.0;
  double last_s_ = 0.0;
  bool is_started_ = false;
};

}  // namespace trocar::devices
