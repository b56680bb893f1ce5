#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "devices/haptic_device.h"
#include "devices/simulated/fault_schedule.h"

namespace trocar::devices {

/// Any device, broken on schedule; times count from its first read. A tool to show what a server does when a device
/// fails, and watched as a real one would be: its slow reads and writes wait, which no other device's do. Seeded: the
/// same reads give the same poses.
class FaultyDevice final : public HapticDevice {
 public:
  /// Waits for so many ms; nanosleep unless a simulation counts instead.
  struct Wait {
    void (*wait)(void* context, double wait_ms) noexcept;
    void* context;
  };

  FaultyDevice(std::unique_ptr<HapticDevice> device, std::vector<ScheduledFault> faults, std::uint64_t seed,
               Wait wait = {});

  const haptics::DevicePreset& preset() const noexcept override { return device_->preset(); }
  std::string name() const override { return "faulty:" + device_->name(); }
  DeviceReading read(double now_s) noexcept override;
  bool write(const haptics::Wrench& wrench_D) noexcept override;
  void hold(const DeviceHand& hand) noexcept override { device_->hold(hand); }
  /// Fails where the device is unplugged for ever. Within the time of its fault the next read finds it gone again.
  Status reconnect() override;

 private:
  const ScheduledFault* find_active(DeviceFault fault) const noexcept;
  void wait_for(DeviceFault fault) const noexcept;
  void shake(Pose& X_DS) noexcept;
  DeviceReading disconnected() noexcept;

  std::unique_ptr<HapticDevice> device_;
  std::vector<ScheduledFault> faults_;
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
  Wait wait_;
  double start_s_ = 0.0;
  double time_s_ = 0.0;  ///< Of the last read, since the first one.
  bool is_started_ = false;
  bool is_disconnected_ = false;
  bool is_inner_gone_ = false;
  bool has_last_ = false;
  DeviceReading last_;  ///< Told last.
};

}  // namespace trocar::devices
