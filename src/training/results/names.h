#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::results {

/// Limit of names of people, courses and accounts.
inline constexpr std::size_t kMaxNameCharacters = 100;
/// A name without blanks at its ends, and with single blanks. Errors (exit status 2): empty, too long, control
/// characters, not UTF-8. `kind`: "the name of a person".
Result<std::string> clean_name(std::string_view name, const char* kind);
/// Names that differ only in case (of a to z) and blanks have the same key, as typed or clean.
std::string name_key(std::string_view name);

/// A text of several lines, without blanks at its ends. Errors (exit status 2): more than `max_characters`, control
/// characters other than line feed and tab, not UTF-8. May be empty.
Result<std::string> clean_text(std::string_view text, std::size_t max_characters, const char* kind);

}  // namespace trocar::results
