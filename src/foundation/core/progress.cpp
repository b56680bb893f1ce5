#include "core/progress.h"

namespace trocar {
inline namespace core {
namespace {

thread_local const std::stop_token* innermost_stop = nullptr;

}  // namespace

CancellationScope::CancellationScope(std::stop_token stop) noexcept
    : stop_(std::move(stop)), outer_(std::exchange(innermost_stop, &stop_)) {}

CancellationScope::~CancellationScope() {
  innermost_stop = outer_;
}

std::stop_token cancellation_token() noexcept {
  return innermost_stop != nullptr ? *innermost_stop : std::stop_token();
}

void cancellation_point() {
  if (innermost_stop != nullptr && innermost_stop->stop_requested()) throw Cancelled();
}

}  // namespace core
}  // namespace trocar
