#include "core/utf8.h"

namespace trocar {
inline namespace core {
namespace {

/// What the lead byte says: length, its bits of the code point, and the least code point of that length.
struct Lead {
  std::size_t bytes;
  char32_t bits;
  char32_t least;
};

std::optional<Lead> find_lead(unsigned char byte) noexcept {
  if (byte < 0x80) return Lead{1, byte, 0};
  if ((byte & 0xE0) == 0xC0) return Lead{2, byte & 0x1FU, 0x80};
  if ((byte & 0xF0) == 0xE0) return Lead{3, byte & 0x0FU, 0x800};
  if ((byte & 0xF8) == 0xF0) return Lead{4, byte & 0x07U, 0x10000};
  return std::nullopt;
}

}  // namespace

std::optional<Utf8Character> first_character(std::string_view text) noexcept {
  if (text.empty()) return std::nullopt;
  const std::optional<Lead> lead = find_lead(static_cast<unsigned char>(text.front()));
  if (!lead || lead->bytes > text.size()) return std::nullopt;
  char32_t c = lead->bits;
  for (std::size_t n = 1; n < lead->bytes; ++n) {
    const auto byte = static_cast<unsigned char>(text[n]);
    if ((byte & 0xC0) != 0x80) return std::nullopt;
    c = (c << 6) | (byte & 0x3FU);
  }
  const bool is_surrogate = c >= 0xD800 && c < 0xE000;
  if (c < lead->least || is_surrogate || c > 0x10FFFF) return std::nullopt;
  return Utf8Character{c, lead->bytes};
}

std::string valid_utf8(std::string_view text) {
  constexpr std::string_view kReplacement = "\xEF\xBF\xBD";
  std::string valid;
  while (!text.empty()) {
    const auto character = first_character(text);
    const std::size_t bytes = character ? character->bytes : 1;
    valid += character ? text.substr(0, bytes) : kReplacement;
    text.remove_prefix(bytes);
  }
  return valid;
}

}  // namespace core
}  // namespace trocar
