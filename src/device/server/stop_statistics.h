#pragma once

#include <algorithm>
#include <cstdint>

#include "realtime/latency_histogram.h"

namespace trocar::server {

/// Times from the receipt of a stop by the link thread to the tick that sees it. Fixed size, real-time safe.
struct StopStatistics {
  realtime::LatencyHistogram waits;
  /// Largest wait minus the lateness of the tick that saw the stop: at most one period if only the machine delays it.
  std::int64_t longest_on_time_ns = 0;

  /// `late_ns`: how long after the first due time since the last tick this tick began.
  void add(std::int64_t wait_ns, std::int64_t late_ns) noexcept {
    waits.add(wait_ns);
    longest_on_time_ns = std::max(longest_on_time_ns, wait_ns - late_ns);
  }
};

}  // namespace trocar::server
