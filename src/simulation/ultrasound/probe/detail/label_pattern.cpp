#include "ultrasound/probe/detail/label_pattern.h"

#include "core/ascii.h"

namespace trocar::ultrasound::detail {

std::string plain_name(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (ascii::is_letter_or_digit(c) || c == '*') text += ascii::to_lower(c);
  }
  return text;
}

bool matches_pattern(std::string_view pattern, std::string_view name) noexcept {
  if (pattern.ends_with('*')) return name.starts_with(pattern.substr(0, pattern.size() - 1));
  return pattern == name;
}

}  // namespace trocar::ultrasound::detail
