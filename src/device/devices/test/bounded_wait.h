#pragma once

#include <poll.h>

namespace trocar::testing {

/// Waits until `holds()` returns true, at most half a minute. Returns false after the timeout.
template <class Predicate>
bool wait_until(Predicate&& holds) {
  constexpr int kMostRounds = 30'000;
  for (int i = 0; i < kMostRounds; ++i) {
    if (holds()) return true;
    ::poll(nullptr, 0, 1);
  }
  return false;
}

}  // namespace trocar::testing
