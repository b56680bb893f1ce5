#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace trocar {
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
}  // namespace trocar
