#include "link/detail/plain_text.h"

#include "core/utf8.h"

namespace trocar::link::detail {
namespace {

bool is_control(char32_t c, Layout layout) {
  if (c == '\t' || c == '\n' || c == '\r') return layout == Layout::kLine;
  return c < 0x20 || (c >= 0x7F && c < 0xA0);
}

}  // namespace

bool is_plain_text(std::string_view text, Layout layout) {
  while (!text.empty()) {
    const auto character = first_character(text);
    if (!character || is_control(character->code_point, layout)) return false;
    text.remove_prefix(character->bytes);
  }
  return true;
}

}  // namespace trocar::link::detail
