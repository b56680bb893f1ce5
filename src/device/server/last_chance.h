#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <cstddef>

#include "devices/haptic_device.h"

namespace trocar::server {

/// Zero force where the program crashes: SIGABRT (std::terminate, failed checks, libraries), SIGSEGV, SIGBUS, SIGFPE,
/// SIGILL, SIGSYS, SIGXCPU. The real-time thread is asked to write zero and to write nothing more; where it does not
/// answer within kPatience_ms, or crashed itself, the handler writes. Then the signal ends the process as it would
/// have. While an object lives its device is registered; handlers are installed with the first one.
class LastChance {
 public:
  static constexpr int kPatience_ms = 20;

  explicit LastChance(devices::HapticDevice& device) noexcept;
  ~LastChance();
  LastChance(const LastChance&) = delete;
  LastChance& operator=(const LastChance&) = delete;

  /// The calling thread is the one that writes the device.
  void adopt_thread() noexcept;
  /// Called by that thread at the start of every period. True: the process is ending and nothing may be written; zero
  /// has been written unless the device is lent (`is_lent`). Real-time safe.
  bool takes_over(bool is_lent) noexcept;

  /// What the handler does; async-signal-safe as far as the device's write() is real-time safe.
  void let_go() noexcept;

 private:
  devices::HapticDevice& device_;
  std::atomic<pid_t> thread_{0};
  std::atomic<bool> is_wanted_{false};
  std::atomic<bool> is_done_{false};
};

/// A stack of its own for the handlers of the calling thread, so that they run after a stack overflow, too.
class CrashStack {
 public:
  CrashStack() noexcept;
  ~CrashStack();
  CrashStack(const CrashStack&) = delete;
  CrashStack& operator=(const CrashStack&) = delete;

 private:
  static constexpr std::size_t kBytes = 64 * 1024;
  alignas(16) std::array<std::byte, kBytes> bytes_;
};

}  // namespace trocar::server
