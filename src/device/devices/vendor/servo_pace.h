#pragma once

#include <atomic>

namespace trocar::devices {

/// What a servo loop of ours does once a period.
class ServoBody {
 public:
  virtual void serve(double now_s) noexcept = 0;

 protected:
  ~ServoBody() = default;
};

/// Clock of a servo loop. The real one wakes at absolute times; a test's wakes on request.
class ServoPace {
 public:
  virtual ~ServoPace() = default;
  /// By the loop's own thread: a period of `body` after the other until `is_stopping`.
  virtual void run(const std::atomic<bool>& is_stopping, ServoBody& body) noexcept = 0;
  /// By another thread, after it set `is_stopping`: ends a long wait.
  virtual void wake() noexcept {}
};

}  // namespace trocar::devices
