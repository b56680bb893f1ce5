#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <cstddef>

#include "devices/haptic_device.h"

namespace trocar::server {

/// Commands zero force when the program crashes: SIGABRT (std::terminate, failed checks, libraries), SIGSEGV, SIGBUS,
/// SIGFPE, SIGILL, SIGSYS, SIGXCPU. The signal handler requests that the real-time thread writes zero once and then
/// nothing more. If that thread does not respond within kTimeout_ms, or has crashed itself, the handler writes zero.
/// Then the signal ends the process with its default action. The constructor registers the device and installs the
/// handlers; the destructor unregisters the device.
class CrashHandler {
 public:
  static constexpr int kTimeout_ms = 20;

  explicit CrashHandler(devices::HapticDevice& device) noexcept;
  ~CrashHandler();
  CrashHandler(const CrashHandler&) = delete;
  CrashHandler& operator=(const CrashHandler&) = delete;

  /// Registers the calling thread as the thread that writes to the device.
  void adopt_thread() noexcept;
  /// That thread calls it at the start of every period. Returns true if the process is ending: the thread must not
  /// write any more; zero has been written unless the device is leased. Real-time safe.
  bool takes_over(bool is_leased) noexcept;

  /// Commands zero force; called by the signal handler. Async-signal-safe as far as the device's write() is real-time
  /// safe.
  void command_zero_force() noexcept;

 private:
  devices::HapticDevice& device_;
  std::atomic<pid_t> thread_{0};
  std::atomic<bool> is_wanted_{false};
  std::atomic<bool> is_done_{false};
};

/// A separate stack for the signal handlers of the calling thread, so that they also run after a stack overflow.
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
