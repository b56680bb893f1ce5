#pragma once

#include <locale.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

/// Letters and digits of ASCII, the same in every locale: where the user's language is Turkish, the standard library
/// has no small letter for I. Other bytes, as those of UTF-8, are neither letters nor digits.
namespace trocar::ascii {

constexpr bool is_digit(char c) noexcept {
  return c >= '0' && c <= '9';
}
constexpr bool is_upper(char c) noexcept {
  return c >= 'A' && c <= 'Z';
}
constexpr bool is_lower(char c) noexcept {
  return c >= 'a' && c <= 'z';
}
constexpr bool is_letter(char c) noexcept {
  return is_upper(c) || is_lower(c);
}
constexpr bool is_letter_or_digit(char c) noexcept {
  return is_letter(c) || is_digit(c);
}
/// Blank, tab, line feed, vertical tab, form feed, carriage return.
constexpr bool is_space(char c) noexcept {
  return c == ' ' || (c >= '\t' && c <= '\r');
}
constexpr char to_lower(char c) noexcept {
  return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
}
constexpr char to_upper(char c) noexcept {
  return is_lower(c) ? static_cast<char>(c - 'a' + 'A') : c;
}

/// The text with small letters.
inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = to_lower(c);
  return lower;
}

}  // namespace trocar::ascii

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
inline namespace core {

/// A text for a field of a CSV file that no spreadsheet takes for a formula, neither as a whole nor in a part: an
/// apostrophe precedes each place where a cell may begin (the begin of the text, and behind a comma, semicolon, tab or
/// line break, by which a spreadsheet of another country may separate) if a formula would begin there. That is one of
/// = + - @ (also in full width), a tab, a line break or an apostrophe, also behind blanks and quotation marks.
std::string guard_formulas(std::string_view text);

/// The text of guard_formulas(text). Texts without such apostrophes stay as they are.
std::string without_formula_guards(std::string_view field);

}  // namespace core
inline namespace core {

/// A number at the start of a text, and the text after it.
template <class Number>
struct LeadingNumber {
  Number value;
  std::string_view rest;
};

/// The longest number at the start of `text`, as std::from_chars reads it: decimal, independent of the locale. Empty if
/// the text starts with something else (also a space, a '+', or the '-' of an unsigned number), if the number does not
/// fit its type, and if it is "nan" or "inf". Real-time safe.
template <class Number>
std::optional<LeadingNumber<Number>> find_leading_number(std::string_view text) noexcept {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>)
    if (!std::isfinite(value)) return std::nullopt;
  return LeadingNumber<Number>{value, text.substr(static_cast<std::size_t>(end - text.data()))};
}

/// Parses the whole text as one finite number. Empty under the conditions above, and if text follows the number.
/// Real-time safe.
template <class Number>
std::optional<Number> parse_number(std::string_view text) noexcept {
  const auto number = find_leading_number<Number>(text);
  if (!number || !number->rest.empty()) return std::nullopt;
  return number->value;
}

}  // namespace core
inline namespace core {

/// During its lifetime, libraries read and write the numbers of this thread with a decimal point and without separators
/// of thousands. Those that call printf or strtod, or use streams, follow the user's locale otherwise, once a program
/// has taken it over, as Qt does for C at its start. Our own code formats by fmt and parses by parse_number(), which
/// know no locale. Where the program has changed the global locale of C++, that has the numbers of the classic one
/// meanwhile, for all threads; the global locale of C is not changed. Thread-safe.
class DecimalPoint {
 public:
  DecimalPoint();
  ~DecimalPoint();
  DecimalPoint(const DecimalPoint&) = delete;
  DecimalPoint& operator=(const DecimalPoint&) = delete;

 private:
  ::locale_t numbers_;
  ::locale_t before_;
};

}  // namespace core
}  // namespace trocar
