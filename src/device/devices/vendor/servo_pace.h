#pragma once

#include <atomic>

namespace trocar::devices {

/// Work of a servo loop in one period.
class ServoBody {
 public:
  virtual void serve(double now_s) noexcept = 0;

 protected:
  ~ServoBody() = default;
};

/// Clock of a servo loop. The real clock wakes at absolute times; the clock of a test wakes on request.
class ServoPace {
 public:
  virtual ~ServoPace() = default;
  /// Runs `body` once per period until `is_stopping` is set. Call it from the thread of the loop.
  virtual void run(const std::atomic<bool>& is_stopping, ServoBody& body) noexcept = 0;
  /// Ends a long wait. Call it from another thread, after that thread has set `is_stopping`.
  virtual void wake() noexcept {}
};

}  // namespace trocar::devices
