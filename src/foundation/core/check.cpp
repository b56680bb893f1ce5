#include "core/check.h"

#include <cstdio>
#include <cstdlib>

namespace trocar {
inline namespace core {
namespace detail {

void check_failed(const char* condition, const char* file, int line) noexcept {
  std::fprintf(stderr, "internal error: check failed: %s — %s:%d — please report this\n", condition, file, line);
  std::abort();
}

}  // namespace detail
}  // namespace core
}  // namespace trocar
