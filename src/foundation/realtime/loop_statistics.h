#pragma once

#include <cstdint>

#include "realtime/latency_histogram.h"

namespace trocar::realtime {

/// Distribution of a duration, microseconds.
struct LatencySummary {
  double p50_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0;
};
LatencySummary summarise(const LatencyHistogram& histogram) noexcept;

/// Statistics of a periodic loop since its start.
struct LoopSummary {
  double wanted_hz = 0.0;
  double achieved_hz = 0.0;   ///< Ticks divided by the elapsed time.
  std::uint64_t periods = 0;  ///< Periods that have begun, including skipped ones.
  std::uint64_t missed = 0;   ///< Periods whose tick was not finished before the next period, including skipped ones.
  std::uint64_t skipped = 0;  ///< Periods without a tick.
  LatencySummary lateness;    ///< Delay of the wake-up after the period's begin.
  LatencySummary tick;        ///< From wake-up to the end of the tick.
  double served() const noexcept {
    return periods == 0 ? 1.0 : 1.0 - static_cast<double>(missed) / static_cast<double>(periods);
  }
};

/// Updated by the loop's thread. Fixed size, real-time safe; do not call summary() in the loop.
class LoopStatistics {
 public:
  explicit LoopStatistics(std::int64_t period_ns = 1'000'000) noexcept : period_ns_(period_ns) {}
  /// Adds one tick: begin of its period, wake-up, end, and number of periods skipped before it.
  void add(std::int64_t begin_ns, std::int64_t woke_ns, std::int64_t done_ns, std::uint64_t skipped) noexcept;
  LoopSummary summary() const noexcept;

 private:
  std::int64_t period_ns_;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  std::uint64_t ticks_ = 0, missed_ = 0, skipped_ = 0;
  LatencyHistogram lateness_, tick_;
};

}  // namespace trocar::realtime
