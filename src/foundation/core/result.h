#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace trocar {
inline namespace core {

/// An error of the outside world (file, device, user input) with the advice to fix it. Printed as "error: what — where
/// — what to do"; empty parts are omitted.
struct Error {
  std::string what;     ///< The failure: "the image ends before its last voxel".
  std::string where;    ///< Place of the failure: a file, a line, an option.
  std::string advice;   ///< Advice to the user.
  int exit_status = 1;  ///< 1: failure at run time (file, device, data). 2: unusable arguments.

  std::string text() const;  ///< "what — where — what to do", one line, control characters replaced.
};

/// A value or an Error. The project's code never throws; the module that calls a library catches its exceptions.
template <class T>
using Result = tl::expected<T, Error>;
using Status = Result<void>;

/// An error to return: `return fail("the image is empty", path.string(), "export it again");`
tl::unexpected<Error> fail(std::string what, std::string where = {}, std::string advice = {});
/// The same for arguments that cannot be used (exit status 2).
tl::unexpected<Error> fail_usage(std::string what, std::string where = {}, std::string advice = {});

}  // namespace core
}  // namespace trocar

/// Returns the error of a Result<T> expression from the enclosing function, else binds its value: TROCAR_TRY(auto ct,
/// load(p));
#define TROCAR_TRY(declaration, expression) \
  TROCAR_TRY_IMPL_(TROCAR_CONCAT_(try_result_, __LINE__), declaration, expression)
/// The same for a Status, without a value.
#define TROCAR_TRY_STATUS(expression)                                                                      \
  do {                                                                                                     \
    if (auto try_status = (expression); !try_status) return tl::unexpected(std::move(try_status).error()); \
  } while (false)

#define TROCAR_CONCAT_IMPL_(a, b) a##b
#define TROCAR_CONCAT_(a, b) TROCAR_CONCAT_IMPL_(a, b)
#define TROCAR_TRY_IMPL_(temporary, declaration, expression)           \
  auto temporary = (expression);                                       \
  if (!temporary) return tl::unexpected(std::move(temporary).error()); \
  declaration = *std::move(temporary)

namespace trocar {
inline namespace core {

/// An error with the place where it occurred in front of its own: "liver.nrrd: trocar_depth_mm".
inline tl::unexpected<Error> fail_at(const std::string& place, Error error) {
  error.where = error.where.empty() ? place : place + ": " + error.where;
  return tl::unexpected(std::move(error));
}

}  // namespace core
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
