#include "core/csv_guard.h"

#include <algorithm>
#include <array>

namespace trocar {
inline namespace core {
namespace {

constexpr char kGuard = '\'';
constexpr std::string_view kBegins = "=+-@\t\r\n'";
/// U+FF1D, U+FF0B, U+FF0D, U+FF20: spreadsheets of East Asia take them for = + - @.
constexpr std::array<std::string_view, 4> kWideBegins{"\xef\xbc\x9d", "\xef\xbc\x8b", "\xef\xbc\x8d", "\xef\xbc\xa0"};
constexpr std::string_view kSeparators = ",;\t\r\n";

bool is_one_of(std::string_view characters, char c) {
  return characters.find(c) != std::string_view::npos;
}

/// Whether a cell with this content would be a formula, or begin with an apostrophe of its own.
bool is_formula(std::string_view cell) {
  cell.remove_prefix(std::min(cell.find_first_not_of(" \""), cell.size()));
  if (cell.empty()) return false;
  return is_one_of(kBegins, cell.front()) ||
         std::any_of(kWideBegins.begin(), kWideBegins.end(), [&](auto begin) { return cell.starts_with(begin); });
}

}  // namespace

std::string guard_formulas(std::string_view text) {
  std::string guarded;
  guarded.reserve(text.size() + 1);
  bool is_begin = true;
  for (std::size_t n = 0; n < text.size(); ++n) {
    if (is_begin && is_formula(text.substr(n))) guarded += kGuard;
    guarded += text[n];
    is_begin = is_one_of(kSeparators, text[n]);
  }
  return guarded;
}

std::string without_formula_guards(std::string_view field) {
  std::string text;
  text.reserve(field.size());
  bool is_begin = true;
  for (std::size_t n = 0; n < field.size(); ++n) {
    if (is_begin && field[n] == kGuard && is_formula(field.substr(n + 1))) ++n;
    text += field[n];
    is_begin = is_one_of(kSeparators, field[n]);
  }
  return text;
}

}  // namespace core
}  // namespace trocar
