#pragma once

namespace trocar {
inline namespace core {
namespace detail {
/// Prints the failed condition and aborts.
[[noreturn]] void check_failed(const char* condition, const char* file, int line) noexcept;
}  // namespace detail
}  // namespace core
}  // namespace trocar

/// Aborts on a programming error at a module boundary; tested in all builds.
#define TROCAR_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::trocar::detail::check_failed(#condition, __FILE__, __LINE__))

/// The same check inside a module; tested in debug builds only.
#ifdef NDEBUG
#define TROCAR_ASSERT(condition) static_cast<void>(sizeof(condition))
#else
#define TROCAR_ASSERT(condition) TROCAR_CHECK(condition)
#endif
