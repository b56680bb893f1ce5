#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::config::detail {

/// Checks that toml++ 3.3 can parse this text safely: size, UTF-8, no control characters, bounded nesting of values and
/// of dotted keys (its parser and destructors recurse), only ASCII outside of strings and comments, and no backslash at
/// the end of a line (both reach code that toml++ marks as unreachable). The error names `name` and the line.
Status check_toml_text(std::string_view text, const std::string& name);

}  // namespace trocar::config::detail
