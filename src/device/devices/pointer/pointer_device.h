#pragma once

#include "devices/haptic_device.h"

namespace trocar::devices {

/// Parameters of the filter between the hand target and the pose. All [assumed].
struct PointerParams {
  double time_constant_s = 0.02;      ///< First order: smooths the steps between a trainer's frames. Range 0..0.5.
  double max_speed_mm_per_s = 400.0;  ///< Speed of a quick hand; turns a distant click into a motion. Range 10..5000.
  double max_turn_rad_per_s = 6.0;    ///< Range 0.1..100.
};

/// Mouse and keyboard of a trainer: the pose follows the trainer's hand target, smoothed. Written forces are only
/// displayed; the tick computes the lag of the pointer. Real-time safe after construction.
class PointerDevice final : public HapticDevice {
 public:
  PointerDevice(haptics::DevicePreset preset, const PointerParams& params) noexcept;

  const haptics::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return preset_.name; }
  DeviceReading read(double now_s) noexcept override;
  /// Returns false for an invalid wrench.
  bool write(const Wrench& wrench_D) noexcept override;
  void hold(const DeviceHand& hand) noexcept override;
  bool is_in_real_hand() const noexcept override { return false; }
  Status reconnect() override { return {}; }

 private:
  haptics::DevicePreset preset_;
  PointerParams params_;
  DeviceHand hand_;
  Pose X_DS_;
  bool was_ever_held_ = false;
  double placed_s_ = 0.0;
  double last_s_ = 0.0;
  bool is_started_ = false;
};

}  // namespace trocar::devices
