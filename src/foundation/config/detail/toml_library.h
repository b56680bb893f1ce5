#pragma once

namespace trocar::config::detail {

/// Throws std::logic_error. Not inline, so that toml++'s noexcept functions can call it without a warning.
[[noreturn]] void give_up(const char* condition);

}  // namespace trocar::config::detail

// toml++ asserts conditions that malformed text can violate ("[ ="): here a failed assertion is a parse error in every
// build type. All uses of toml++ include this header, so that they see the same definitions.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(condition) ((condition) ? static_cast<void>(0) : ::trocar::config::detail::give_up(#condition))
#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")
