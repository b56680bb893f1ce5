#pragma once

#include <chrono>

namespace trocar {
inline namespace core {

/// Monotonic clock of code that waits for other processes. Plug point: the steady clock, or the clock of a test
/// (core/testing/fake_clock.h). Real-time code takes time as an argument instead.
class Clock {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;
  virtual ~Clock() = default;
  virtual TimePoint now() const noexcept = 0;
  virtual void sleep_for(Duration duration) = 0;
};

/// std::chrono::steady_clock. May be used by several threads.
class SteadyClock final : public Clock {
 public:
  TimePoint now() const noexcept override;
  void sleep_for(Duration duration) override;
};

inline double seconds_between(Clock::TimePoint from, Clock::TimePoint to) noexcept {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace core
}  // namespace trocar
