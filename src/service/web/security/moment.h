#pragma once

#include <chrono>

namespace trocar::web {

/// The time of a request. Delays are measured by the steady clock, which nobody sets; logins are stored by the
/// calendar.
struct Moment {
  std::chrono::steady_clock::time_point steady;
  std::chrono::sys_seconds utc;
};

}  // namespace trocar::web
