#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "core/clock.h"

namespace trocar::testing {

/// A clock whose time changes only by advance() and sleep_for(). It advances in steps of 1 ms and calls each
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
      for (std::size_t i = 0; i < participants_.size(); ++i)
        if (const auto participant = participants_[i].lock()) (*participant)();
    }
  }
  /// Called after every step, until the returned handle is released.
  [[nodiscard]] std::shared_ptr<const void> attach(std::function<void()> participant) {
    auto shared = std::make_shared<const std::function<void()>>(std::move(participant));
    participants_.push_back(shared);
    return shared;
  }

 private:
  TimePoint now_{std::chrono::hours(1)};  // with a start at 0, a time point that was never set would not be detected
  std::vector<std::weak_ptr<const std::function<void()>>> participants_;
};

}  // namespace trocar::testing
