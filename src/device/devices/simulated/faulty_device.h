#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "devices/haptic_device.h"

namespace trocar::devices {

/// Fault of a FaultyDevice.
enum class DeviceFault : std::uint8_t {
  kJitter,      ///< The position has uniform noise of `amount` mm.
  kDropped,     ///< Reads repeat the last reading.
  kNan,         ///< Poses are NaN.
  kStuck,       ///< The encoder value is frozen, but reads report new data.
  kJump,        ///< The pose is `amount` mm off.
  kDisconnect,  ///< Reads report disconnected, writes fail.
  kSlowWrite,   ///< Writes take `amount` ms.
  kSlowRead,    ///< Reads take `amount` ms.
};
const char* to_string(DeviceFault fault) noexcept;

/// Upper bound of a slow read or write, so that the server can still be stopped.
inline constexpr double kMaxSlow_ms = 2000.0;

struct ScheduledFault {
  DeviceFault fault = DeviceFault::kJitter;
  double from_s = 0.0;  ///< Since the device's first read.
  double for_s = 0.0;   ///< Infinite: the fault has no end.
  double amount = 0.0;
};

/// "nan@2.0+0.5", "jitter:0.3@1+2", "disconnect@5": KIND[:AMOUNT]@FROM_S[+FOR_S].
/// Errors (exit status 2): another format.
Result<ScheduledFault> parse_fault(std::string_view text);

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

  const stylus::DevicePreset& preset() const noexcept override { return device_->preset(); }
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
