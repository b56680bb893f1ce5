#include "web/security/log_text.h"

#include "core/utf8.h"

namespace trocar::web {

std::string log_text(std::string_view text) {
  constexpr std::size_t kMostBytes = 60;
  std::string safe = "\"";
  while (!text.empty()) {
    const auto character = first_character(text);
    const std::size_t bytes = character ? character->bytes : 1;
    if (safe.size() + bytes > kMostBytes) return safe + "…\"";
    const bool is_plain = character && is_printable(character->code_point) && character->code_point != '"' &&
                          character->code_point != '\\';
    safe += is_plain ? text.substr(0, bytes) : "?";
    text.remove_prefix(bytes);
  }
  return safe + "\"";
}

}  // namespace trocar::web
