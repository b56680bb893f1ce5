#pragma once

#include <cstdint>

#include "realtime/latency_histogram.h"

namespace trocar::realtime {

/// A duration's distribution, microseconds.
struct LatencySummary {
  double p50_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0;
};
LatencySummary summarise(const LatencyHistogram& histogram) noexcept;

/// Statistics of a periodic loop since its start.
struct LoopSummary {
  double wanted_hz = 0.0;
  double achieved_hz = 0.0;   ///< Ticks over the time they took.
  std::uint64_t periods = 0;  ///< That have begun, skipped ones too.
  std::uint64_t missed = 0;   ///< Periods whose tick was not finished before the next period, including skipped ones.
  std::uint64_t skipped = 0;  ///< That got no tick at all.
  LatencySummary lateness;    ///< Of the wake-up after the period's begin.
  LatencySummary tick;        ///< From wake-up to the end of the tick.
  double served() const noexcept {
    return periods == 0 ? 1.0 : 1.0 - static_cast<double>(missed) / static_cast<double>(periods);
  }
};

/// Kept by the loop's thread. Fixed size, real-time safe; summary() is not for the loop.
class LoopStatistics {
 public:
  explicit LoopStatistics(std::int64_t period_ns = 1'000'000) noexcept : period_ns_(period_ns) {}
  /// One tick: when its period began, when it woke and when it was done, and the periods that were skipped before it.
  void add(std::int64_t begin_ns, std::int64_t woke_ns, std::int64_t done_ns, std::uint64_t skipped) noexcept;
  LoopSummary summary() const noexcept;

 private:
  std::int64_t period_ns_;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  std::uint64_t ticks_ = 0, missed_ = 0, skipped_ = 0;
  LatencyHistogram lateness_, tick_;
};

}  // namespace trocar::realtime
