#pragma once

#include <string>

namespace trocar::realtime {

/// Real-time privileges that the system granted to a thread.
struct RealTimeGrant {
  bool was_asked = false;          ///< Real-time scheduling (priority > 0) was requested.
  bool has_fifo = false;           ///< SCHED_FIFO.
  bool has_locked_memory = false;  ///< mlockall of present and future pages.
  bool has_fine_timers = false;    ///< Timer slack of 1 ns (matters without SCHED_FIFO).
  int priority = 0;                ///< Priority of SCHED_FIFO.

  /// "SCHED_FIFO priority 80, memory locked", or the refused privileges and how to allow them.
  std::string text() const;
};

/// Requests all privileges for the calling thread (memory: for the process). Priority 1..99; 0 requests fine timers
/// only. Never fails: privileges that are not granted are skipped.
RealTimeGrant request_real_time(int priority = 80) noexcept;

}  // namespace trocar::realtime
