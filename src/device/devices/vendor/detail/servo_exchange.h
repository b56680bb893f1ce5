#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "devices/haptic_device.h"
#include "devices/simulated/detail/hand_motion.h"  // is_valid
#include "geometry/vec.h"
#include "realtime/lock_free.h"

namespace trocar::devices {

/// Result of one period of a vendor's servo loop.
struct ServoSample {
  Pose X_DS;
  std::uint32_t buttons = 0;
  bool is_force_refused = false;  ///< The vendor's safety functions keep the motors off or reduced the force.
  bool is_lost = false;           ///< The device is disconnected.
};

/// Exchanges readings and wrenches between the real-time thread and a vendor's servo loop. Neither waits for the other.
/// An outdated wrench counts as zero: if the real-time thread hangs, the motors get no force.
class ServoExchange {
 public:
  /// The wrench is zero if no new one came for longer than this: twenty periods of the slowest loop. [assumed]
  static constexpr double kOldestWrench_s = 0.020;
  /// The device counts as disconnected (the servo loop hangs) if no sample came for longer than this and in more than
  /// kLongestSilence_reads reads. The count of reads prevents this after a stop of the whole process. [assumed]
  static constexpr double kLongestSilence_s = 0.100;
  static constexpr int kLongestSilence_reads = 20;

  explicit ServoExchange(const ServoSample& first) : sample_(first), samples_(first) {}

  /// For the real-time thread.
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
  /// For the real-time thread. Limits force and torque to the peaks of the device; a peak torque of zero removes the
  /// torque. Returns false if the wrench is invalid (zero is sent instead), the vendor's safety functions refuse
  /// forces, or the device is disconnected.
  bool write(const Wrench& wrench_D, const stylus::DeviceCapability& capability) noexcept {
    const bool is_taken = is_valid(wrench_D);
    Wrench sent;
    if (is_taken) {
      sent.force_n = clamped_norm(wrench_D.force_n, capability.peak_force_n);
      sent.torque_nmm = clamped_norm(wrench_D.torque_nmm, capability.peak_torque_nmm);
    }
    wrenches_.write(sent);
    return is_taken && !sample_.is_force_refused && !is_lost();
  }

  /// For the servo loop: the present wrench for the motors.
  Wrench wanted(double now_s) noexcept {
    if (wrenches_.update()) {
      written_s_ = now_s;
      has_written_ = true;
    }
    const bool is_old = !has_written_ || !(now_s - written_s_ <= kOldestWrench_s);
    return is_old || is_closing_.load(std::memory_order_acquire) ? Wrench{} : wrenches_.value();
  }
  /// For the servo loop: publishes a sample.
  void sensed(const ServoSample& sample) noexcept { samples_.write(sample); }

  /// For the thread that closes the device: from now on, wanted() returns zero.
  void close() noexcept { is_closing_.store(true, std::memory_order_release); }
  /// For any thread: true if read() has returned kDisconnected.
  bool is_lost() const noexcept { return is_lost_.load(std::memory_order_relaxed); }

 private:
  // Used only by the real-time thread.
  ServoSample sample_;
  double heard_s_ = 0.0;
  int silent_reads_ = 0;
  bool has_read_ = false;
  // Used only by the servo loop.
  double written_s_ = 0.0;
  bool has_written_ = false;

  realtime::TripleBuffer<ServoSample> samples_;
  realtime::TripleBuffer<Wrench> wrenches_;
  std::atomic<bool> is_closing_{false};
  std::atomic<bool> is_lost_{false};
};

/// Work of a servo loop in one period.
class ServoBody {
 public:
  virtual void serve(double now_s) noexcept = 0;

 protected:
  ~ServoBody() = default;
};

/// Clock of a servo loop. The real clock wakes at absolute times; the clock of a test wakes on request.
class ServoPace {
 public:
  virtual ~ServoPace() = default;
  /// Runs `body` once per period until `is_stopping` is set. Call it from the thread of the loop.
  virtual void run(const std::atomic<bool>& is_stopping, ServoBody& body) noexcept = 0;
  /// Ends a long wait. Call it from another thread, after that thread has set `is_stopping`.
  virtual void wake() noexcept {}
};

}  // namespace trocar::devices
