#pragma once

#include <algorithm>

namespace trocar::link::detail {

/// A rate limit: `burst` at once, `per_s` on average. Time is an argument.
class TokenBucket {
 public:
  TokenBucket(double per_s, double burst) noexcept : per_s_(per_s), burst_(burst), tokens_(burst) {}

  void refill(double now_s) noexcept {
    if (has_time_) tokens_ = std::min(burst_, tokens_ + per_s_ * std::max(0.0, now_s - filled_s_));
    filled_s_ = now_s;
    has_time_ = true;
  }
  bool has_tokens() const noexcept { return tokens_ >= 1.0; }
  /// May take more tokens than there are; has_tokens() is then false until the deficit is refilled.
  void take(double amount) noexcept { tokens_ -= amount; }

 private:
  double per_s_, burst_, tokens_;
  double filled_s_ = 0.0;
  bool has_time_ = false;
};

}  // namespace trocar::link::detail
