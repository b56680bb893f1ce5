#include "results/names.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"

namespace trocar::results {
namespace {

bool is_control(char32_t c) {
  // Also the marks that change the direction of writing, which can make one name look like another.
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || (c >= 0x202a && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069) ||
         c == 0x2028 || c == 0x2029 || c == 0xfeff;
}

bool is_blank(char32_t c) {
  return c == ' ' || c == 0xa0 || c == 0x3000;
}

/// Checks all characters; returns their number.
Result<std::size_t> check(std::string_view text, bool has_lines, const char* kind) {
  std::size_t count = 0;
  for (std::string_view rest = text; !rest.empty(); ++count) {
    const auto character = first_character(rest);
    if (!character) return fail_usage(fmt::format("{} is not UTF-8", kind), {}, "write it again");
    const bool is_line = has_lines && (character->code_point == '\n' || character->code_point == '\t');
    if (is_control(character->code_point) && !is_line)
      return fail_usage(fmt::format("{} contains a control character", kind), {}, "write it again");
    rest.remove_prefix(character->bytes);
  }
  return count;
}

}  // namespace

Result<std::string> clean_name(std::string_view name, const char* kind) {
  TROCAR_TRY_STATUS(check(name, false, kind));
  std::string clean;
  std::size_t count = 0;
  bool is_after_blank = false;
  for (std::string_view rest = name; !rest.empty();) {
    const auto character = first_character(rest);
    if (is_blank(character->code_point)) {
      is_after_blank = !clean.empty();
    } else {
      if (is_after_blank) clean += ' ', ++count;
      is_after_blank = false;
      clean += rest.substr(0, character->bytes);
      ++count;
    }
    rest.remove_prefix(character->bytes);
  }
  if (clean.empty()) return fail_usage(fmt::format("{} is empty", kind), {}, "give a name");
  if (count > kMaxNameCharacters)
    return fail_usage(fmt::format("{} has {} characters", kind, count), {},
                      fmt::format("use at most {}", kMaxNameCharacters));
  return clean;
}

std::string name_key(std::string_view name) {
  const auto clean = clean_name(name, "the name");
  return ascii::lower_case(clean ? std::string_view(*clean) : name);  // one that cannot be used is nobody's
}

Result<std::string> clean_text(std::string_view text, std::size_t max_characters, const char* kind) {
  std::string clean(text);
  std::erase(clean, '\r');
  const auto begin = clean.find_first_not_of(" \n\t");
  clean = begin == std::string::npos ? "" : clean.substr(begin, clean.find_last_not_of(" \n\t") + 1 - begin);
  TROCAR_TRY(const std::size_t count, check(clean, true, kind));
  if (count > max_characters)
    return fail_usage(fmt::format("{} has {} characters", kind, count), {},
                      fmt::format("use at most {}", max_characters));
  return clean;
}

}  // namespace trocar::results
