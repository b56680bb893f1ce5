#pragma once

namespace trocar {
inline namespace core {

/// Called with the text of a failed check, in the thread that failed it.
using CheckHandler = void (*)(const char* text);

/// Replaces what a failed check does, for programs that embed Trocar and must not be aborted (a Python interpreter): a
/// handler that throws hands its exception to the caller of the function that failed. After one that returns, and where
/// the exception would leave a function that is noexcept, the program is aborted. Null: as at the start, prints the
/// text and aborts. Returns the handler before. Thread-safe.
CheckHandler set_check_handler(CheckHandler handler) noexcept;

namespace detail {
[[noreturn]] void check_failed(const char* condition, const char* file, int line);
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
