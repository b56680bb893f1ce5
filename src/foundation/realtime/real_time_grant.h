#pragma once

#include <string>

namespace trocar::realtime {

/// What the machine gave a thread that wants to be on time.
struct RealTimeGrant {
  bool was_asked = false;          ///< Somebody wanted it.
  bool has_fifo = false;           ///< SCHED_FIFO.
  bool has_locked_memory = false;  ///< mlockall of present and future pages.
  bool has_fine_timers = false;    ///< Timer slack of 1 ns (matters without SCHED_FIFO).
  int priority = 0;                ///< Of SCHED_FIFO.

  /// "SCHED_FIFO priority 80, memory locked", or what was refused and how to allow it.
  std::string text() const;
};

/// Asks for all of it for the calling thread (memory: for the process). Priority 1..99; 0 asks for fine timers alone.
/// Never fails: what is not granted is left.
RealTimeGrant request_real_time(int priority = 80) noexcept;

}  // namespace trocar::realtime
