#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "devices/vendor/detail/servo_exchange.h"

namespace trocar::testing {

/// Clock of a servo loop that runs the number of periods that the test requests, at the time of the test.
class SteppedPace final : public devices::ServoPace {
 public:
  void run(const std::atomic<bool>& is_stopping, devices::ServoBody& body) noexcept override {
    std::unique_lock lock(mutex_);
    while (!is_stopping.load()) {
      if (granted_ == 0 && !is_free_) {
        changed_.wait(lock);
        continue;
      }
      const double now_s = now_s_;
      lock.unlock();
      body.serve(now_s);
      if (is_free_) std::this_thread::yield();
      lock.lock();
      if (granted_ > 0) --granted_;
      changed_.notify_all();
    }
  }
  void wake() noexcept override {
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
  }

  /// Runs `periods` periods and waits until they are done.
  void step(int periods) {
    std::unique_lock lock(mutex_);
    granted_ = periods;
    changed_.notify_all();
    changed_.wait(lock, [&] { return granted_ == 0; });
  }
  void run_freely() {
    is_free_ = true;
    wake();
  }
  void advance(double time_s) {
    const std::lock_guard lock(mutex_);
    now_s_ += time_s;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int granted_ = 0;
  std::atomic<bool> is_free_{false};
  double now_s_ = 1000.0;
};

}  // namespace trocar::testing
