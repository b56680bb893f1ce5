#pragma once

#include <time.h>

namespace trocar::bench {

/// Processor time of this process, all threads, ms.
inline double processor_time_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace trocar::bench
