#pragma once

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "core/clock.h"

namespace trocar::testing {

/// A clock that stands still until it is advanced. Sleeping advances it. It advances in steps of 1 ms and calls each
/// participant after every step, so that simulated peers act in the same time. One thread.
class FakeClock final : public Clock {
 public:
  static constexpr Duration kStep = std::chrono::milliseconds(1);

  TimePoint now() const noexcept override { return now_; }
  void sleep_for(Duration duration) override { advance(duration); }

  /// A last step that is shorter than kStep calls the participants as well.
  void advance(Duration duration) {
    const TimePoint end = now_ + duration;
    while (now_ < end) {
      now_ = std::min(now_ + kStep, end);
      for (const auto& participant : participants_) participant();
    }
  }
  /// Called after every step. What it refers to must outlive the clock's last advance.
  void attach(std::function<void()> participant) { participants_.push_back(std::move(participant)); }

 private:
  TimePoint now_{std::chrono::hours(1)};  // a clock of 0 would hide what was never set
  std::vector<std::function<void()>> participants_;
};

}  // namespace trocar::testing
