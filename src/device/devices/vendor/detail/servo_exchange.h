#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "devices/haptic_device.h"
#include "devices/simulated/detail/hand_motion.h"  // is_valid
#include "geometry/clamp_norm.h"
#include "realtime/triple_buffer.h"

namespace trocar::devices {

/// What one period of a vendor's servo loop sensed and was told.
struct ServoSample {
  Pose X_DS;
  std::uint32_t buttons = 0;
  bool is_force_refused = false;  ///< The vendor's own safety keeps the motors off, or took part of the force.
  bool is_lost = false;           ///< No device any more.
};

/// Between our real-time thread and a vendor's servo loop, neither of which ever waits for the other. A wrench that
/// grows old is zero: a tick that hangs leaves no force in the motors.
class ServoExchange {
 public:
  /// No fresh wrench for longer than this: zero. Twenty periods of the slowest loop. [assumed]
  static constexpr double kOldestWrench_s = 0.020;
  /// No sample for longer than this, in so many reads at least (a process that was stopped as a whole lost nothing):
  /// the servo loop hangs, the device is as good as gone. [assumed]
  static constexpr double kLongestSilence_s = 0.100;
  static constexpr int kLongestSilence_reads = 20;

  explicit ServoExchange(const ServoSample& first) : sample_(first), samples_(first) {}

  /// By the real-time thread.
  DeviceReading read(double now_s) noexcept {
    const bool is_new = samples_.update();
    if (is_new) sample_ = samples_.value();
    if (is_new || !has_read_) {
      heard_s_ = now_s;
      silent_reads_ = 0;
    }
    has_read_ = true;
    silent_reads_ = std::min(silent_reads_ + 1, kLongestSilence_reads + 1);
    const bool is_silent = silent_reads_ > kLongestSilence_reads && now_s - heard_s_ > kLongestSilence_s;
    if (sample_.is_lost || is_silent) is_lost_.store(true, std::memory_order_relaxed);
    DeviceReading reading;
    reading.X_DS = sample_.X_DS;
    reading.buttons = sample_.buttons;
    reading.status = is_lost() ? DeviceStatus::kDisconnected : is_new ? DeviceStatus::kFresh : DeviceStatus::kRepeated;
    return reading;
  }
  /// By the real-time thread. Cut to the device's peaks, a torque left out where that peak is zero. false: no gate
  /// wrote that (zero goes out instead), the vendor's safety refuses forces, or the device is lost.
  bool write(const haptics::Wrench& wrench_D, const haptics::DeviceCapability& capability) noexcept {
    const bool is_taken = is_valid(wrench_D);
    haptics::Wrench sent;
    if (is_taken) {
      sent.force_n = clamped_norm(wrench_D.force_n, capability.peak_force_n);
      sent.torque_nmm = clamped_norm(wrench_D.torque_nmm, capability.peak_torque_nmm);
    }
    wrenches_.write(sent);
    return is_taken && !sample_.is_force_refused && !is_lost();
  }

  /// By the servo loop: what the motors are to get now.
  haptics::Wrench wanted(double now_s) noexcept {
    if (wrenches_.update()) {
      written_s_ = now_s;
      has_written_ = true;
    }
    const bool is_old = !has_written_ || !(now_s - written_s_ <= kOldestWrench_s);
    return is_old || is_closing_.load(std::memory_order_acquire) ? haptics::Wrench{} : wrenches_.value();
  }
  /// By the servo loop.
  void sensed(const ServoSample& sample) noexcept { samples_.write(sample); }

  /// By whoever closes the device: nothing but zero from now on.
  void close() noexcept { is_closing_.store(true, std::memory_order_release); }
  /// By any thread: the reader was told so.
  bool is_lost() const noexcept { return is_lost_.load(std::memory_order_relaxed); }

 private:
  // Of the real-time thread.
  ServoSample sample_;
  double heard_s_ = 0.0;
  int silent_reads_ = 0;
  bool has_read_ = false;
  // Of the servo loop.
  double written_s_ = 0.0;
  bool has_written_ = false;

  realtime::TripleBuffer<ServoSample> samples_;
  realtime::TripleBuffer<haptics::Wrench> wrenches_;
  std::atomic<bool> is_closing_{false};
  std::atomic<bool> is_lost_{false};
};

}  // namespace trocar::devices
