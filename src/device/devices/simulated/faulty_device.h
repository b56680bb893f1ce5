#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "devices/haptic_device.h"
#include "devices/simulated/fault_schedule.h"

namespace trocar::devices {

/// Wraps any device and injects faults at given times, to test the server's reaction to device faults. Time starts at
/// the first read. Slow reads and writes block, unlike those of other devices. The noise is seeded: the same reads give
/// the same poses. It counts as held by a person, so that the server watches it for readings that never change.
class FaultyDevice final : public HapticDevice {
 public:
  /// Function that waits for `wait_ms`. The default is nanosleep; a simulation may count the time instead.
  struct Wait {
    void (*wait)(void* context, double wait_ms) noexcept;
    void* context;
  };

  FaultyDevice(std::unique_ptr<HapticDevice> device, std::vector<ScheduledFault> faults, std::uint64_t seed,
               Wait wait = {});

  const haptics::DevicePreset& preset() const noexcept override { return device_->preset(); }
  std::string name() const override { return "faulty:" + device_->name(); }
  DeviceReading read(double now_s) noexcept override;
  bool write(const Wrench& wrench_D) noexcept override;
  void hold(const DeviceHand& hand) noexcept override { device_->hold(hand); }
  /// Fails if the fault "disconnect" has no end. During the fault the next read reports disconnected again.
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
  double time_s_ = 0.0;  ///< Time of the last read, since the first read.
  bool is_started_ = false;
  bool is_disconnected_ = false;
  bool is_inner_gone_ = false;
  bool has_last_ = false;
  DeviceReading last_;  ///< Last reading without NaN.
};

}  // namespace trocar::devices
