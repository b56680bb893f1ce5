#pragma once

#include <time.h>

#include <atomic>
#include <cstdint>
#include <string>

#include "realtime/loop_statistics.h"

namespace trocar::realtime {

/// Steady clock, ns.
inline std::int64_t now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}
inline double seconds(std::int64_t ns) noexcept {
  return static_cast<double>(ns) * 1e-9;
}
/// Sleeps until `then_ns`; continues to sleep after a signal.
inline void sleep_until_ns(std::int64_t then_ns) noexcept {
  const timespec then{then_ns / 1'000'000'000, then_ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &then, nullptr) != 0) {
  }
}

/// One period, passed to the body of the loop.
struct Period {
  std::int64_t begin_ns = 0;  ///< Due time, ns of the steady clock.
  double now_s = 0.0;         ///< Due time, seconds of the steady clock.
  double dt_s = 0.0;          ///< From the last tick's period: one period, more if some were skipped.
  std::uint64_t number = 0;   ///< Number of the period, counting skipped ones.
};

/// Calls `body(const Period&, const LoopStatistics&)` at absolute times until `is_stopping`. A late period is counted
/// and skipped. The statistics cover the previous ticks. Runs on the calling thread; request real-time scheduling
/// before.
template <class Body>
void run_periodic(std::int64_t period_ns, const std::atomic<bool>& is_stopping, LoopStatistics& statistics,
                  Body&& body) noexcept {
  Period period;
  period.begin_ns = now_ns() + period_ns;
  period.dt_s = seconds(period_ns);
  std::uint64_t skipped = 0;
  while (!is_stopping.load(std::memory_order_relaxed)) {
    sleep_until_ns(period.begin_ns);
    const std::int64_t woke_ns = now_ns();
    period.now_s = seconds(period.begin_ns);
    body(static_cast<const Period&>(period), static_cast<const LoopStatistics&>(statistics));
    const std::int64_t done_ns = now_ns();
    statistics.add(period.begin_ns, woke_ns, done_ns, skipped);

    // The first begin in the future. All begins that passed while the tick ran are skipped.
    const std::int64_t late_ns = done_ns - period.begin_ns;
    const std::int64_t steps = late_ns < period_ns ? 1 : late_ns / period_ns + 1;
    skipped = static_cast<std::uint64_t>(steps - 1);
    period.begin_ns += steps * period_ns;
    period.number += static_cast<std::uint64_t>(steps);
    period.dt_s = seconds(steps * period_ns);
  }
}

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
