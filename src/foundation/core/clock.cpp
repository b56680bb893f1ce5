#include "core/clock.h"

#include <thread>

namespace trocar {
inline namespace core {

Clock::TimePoint SteadyClock::now() const noexcept {
  return std::chrono::steady_clock::now();
}

void SteadyClock::sleep_for(Duration duration) {
  std::this_thread::sleep_for(duration);
}

}  // namespace core
}  // namespace trocar
