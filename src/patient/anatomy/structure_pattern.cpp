#include "anatomy/structure_pattern.h"

#include <algorithm>
#include <array>

#include "core/ascii.h"

namespace trocar::anatomy {
namespace {

constexpr std::array<std::string_view, 2> kSides = {"left", "right"};
constexpr std::string_view kSeparators = "_- ";
constexpr std::string_view kSpineRegions = "ctls";

bool is_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), ascii::is_digit);
}

bool is_name_character(char c) {
  return ascii::is_letter_or_digit(c) || kSeparators.find(c) != std::string_view::npos;
}

}  // namespace

std::string plain_name(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (ascii::is_letter_or_digit(c)) text += ascii::to_lower(c);
  }
  return text;
}

std::string without_side(std::string plain) {
  for (const std::string_view side : kSides) {
    if (const auto at = plain.find(side); at != std::string::npos) plain.erase(at, side.size());
  }
  return plain;
}

std::optional<StructurePattern> StructurePattern::parse(std::string_view text) {
  const std::string_view stem = text.substr(0, text.find_first_of("%#*"));
  const std::string_view end = text.substr(stem.size());
  if (!std::all_of(stem.begin(), stem.end(), is_name_character)) return std::nullopt;
  if (!end.empty() && end != "#" && end != "%#" && end != "*") return std::nullopt;
  StructurePattern pattern;
  pattern.stem_ = plain_name(stem);
  pattern.end_ = std::string(end);
  if (pattern.stem_.empty() || pattern.stem_ != without_side(pattern.stem_)) return std::nullopt;
  return pattern;
}

bool StructurePattern::matches(std::string_view key) const {
  if (!key.starts_with(stem_)) return false;
  std::string_view rest = key.substr(stem_.size());
  if (end_.empty()) return rest.empty();
  if (end_ == "*") return true;
  if (has_region()) {
    if (rest.empty() || kSpineRegions.find(rest.front()) == std::string_view::npos) return false;
    rest.remove_prefix(1);
  }
  return is_digits(rest);
}

}  // namespace trocar::anatomy
