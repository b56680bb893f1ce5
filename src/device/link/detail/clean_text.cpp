#include "link/detail/clean_text.h"

#include <cstddef>
#include <optional>

namespace trocar::link::detail {
namespace {

/// Code points by the lead byte of UTF-8: number of following bytes, and the smallest value (no overlong forms).
struct Lead {
  int following;
  char32_t bits;
  char32_t least;
};
std::optional<Lead> read_lead(unsigned char byte) {
  if (byte < 0x80) return Lead{0, byte, 0};
  if ((byte & 0xE0) == 0xC0) return Lead{1, byte & 0x1FU, 0x80};
  if ((byte & 0xF0) == 0xE0) return Lead{2, byte & 0x0FU, 0x800};
  if ((byte & 0xF8) == 0xF0) return Lead{3, byte & 0x07U, 0x10000};
  return std::nullopt;
}

bool is_clean_character(char32_t c, Layout layout) {
  if (c == '\t' || c == '\n' || c == '\r') return layout == Layout::kLines;
  const bool is_control = c < 0x20 || (c >= 0x7F && c < 0xA0);
  const bool is_surrogate = c >= 0xD800 && c < 0xE000;
  return !is_control && !is_surrogate && c <= 0x10FFFF;
}

}  // namespace

bool is_clean_text(std::string_view text, Layout layout) {
  for (std::size_t i = 0; i < text.size();) {
    const std::optional<Lead> lead = read_lead(static_cast<unsigned char>(text[i++]));
    if (!lead || static_cast<std::size_t>(lead->following) > text.size() - i) return false;
    char32_t c = lead->bits;
    for (int k = 0; k < lead->following; ++k) {
      const auto byte = static_cast<unsigned char>(text[i++]);
      if ((byte & 0xC0) != 0x80) return false;
      c = (c << 6) | (byte & 0x3FU);
    }
    if (c < lead->least || !is_clean_character(c, layout)) return false;
  }
  return true;
}

}  // namespace trocar::link::detail
