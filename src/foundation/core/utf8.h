#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace trocar {
inline namespace core {

struct Utf8Character {
  char32_t code_point;
  std::size_t bytes;  ///< Length in the text, 1 to 4.
};

/// The first character of a text in UTF-8. Empty if the text is empty or starts with a malformed character: a truncated
/// or overlong form, a surrogate, a value beyond U+10FFFF (Unicode, table 3-7). Real-time safe.
std::optional<Utf8Character> first_character(std::string_view text) noexcept;

/// False for control characters (C0, DEL, C1), separators of lines and paragraphs, and characters that change the
/// order of others (U+202A to U+202E, U+2066 to U+2069). Real-time safe.
constexpr bool is_printable(char32_t c) noexcept {
  return c >= 0x20 && !(c >= 0x7f && c < 0xa0) && !(c >= 0x2028 && c <= 0x202e) && !(c >= 0x2066 && c <= 0x2069);
}

/// `text` with every byte that is not part of a well-formed character replaced by U+FFFD.
std::string valid_utf8(std::string_view text);

}  // namespace core
}  // namespace trocar
