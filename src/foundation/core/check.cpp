#include "core/check.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace trocar {
inline namespace core {
namespace {

void print_failure(const char* text) {
  std::fprintf(stderr, "%s\n", text);
}

std::atomic<CheckHandler> check_handler{print_failure};

}  // namespace

CheckHandler set_check_handler(CheckHandler handler) noexcept {
  const CheckHandler before = check_handler.exchange(handler == nullptr ? print_failure : handler);
  return before == print_failure ? nullptr : before;
}

namespace detail {

void check_failed(const char* condition, const char* file, int line) {
  constexpr std::size_t kMostText = 1024;
  char text[kMostText];
  std::snprintf(text, sizeof(text), "internal error: check failed: %s — %s:%d — please report this", condition, file,
                line);
  check_handler.load()(text);
  std::abort();
}

}  // namespace detail
}  // namespace core
}  // namespace trocar
