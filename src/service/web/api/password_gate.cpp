#include "web/api/password_gate.h"

namespace trocar::web {

bool PasswordGate::enter() {
  std::unique_lock lock(mutex_);
  if (waiting_ >= kMostWaiting) return false;
  ++waiting_;
  has_left_.wait(lock, [this] { return inside_ < kMostInside; });
  --waiting_;
  ++inside_;
  return true;
}

void PasswordGate::leave() {
  {
    const std::lock_guard lock(mutex_);
    --inside_;
  }
  has_left_.notify_one();
}

}  // namespace trocar::web
