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
