#pragma once

#include <condition_variable>
#include <mutex>

namespace trocar::web {

/// Lets two threads hash passwords at a time, 64 MiB each, and a bounded number wait. Thread-safe.
class PasswordGate {
 public:
  /// Room to hash one password; the destructor gives it back. False: too many wait.
  class Pass {
   public:
    explicit Pass(PasswordGate& gate) : gate_(gate), is_inside_(gate.enter()) {}
    ~Pass() {
      if (is_inside_) gate_.leave();
    }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;
    explicit operator bool() const noexcept { return is_inside_; }

   private:
    PasswordGate& gate_;
    const bool is_inside_;
  };

 private:
  bool enter();
  void leave();

  static constexpr int kMostInside = 2;
  static constexpr int kMostWaiting = 40;  ///< The last one waits about a second.
  std::mutex mutex_;
  std::condition_variable has_left_;
  int inside_ = 0, waiting_ = 0;
};

}  // namespace trocar::web
