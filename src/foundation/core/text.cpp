#include "core/text.h"

#include <algorithm>
#include <array>
#include <clocale>
#include <locale>
#include <mutex>
#include <string>

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
inline namespace core {
namespace {

/// The global locale of C++, while it is replaced.
struct ReplacedLocale {
  std::mutex mutex;
  int count = 0;
  std::locale before;
};

ReplacedLocale& replaced_locale() {
  static ReplacedLocale shared;
  return shared;
}

/// The classic locale, without its name: global() gives a name to C's setlocale(), too.
std::locale make_nameless_classic() {
  return {std::locale::classic(), new std::numpunct<char>};
}

/// Makes it the global locale of C++. That of C stays as it is.
void restore(const std::locale& before) {
  const std::string of_c = std::setlocale(LC_ALL, nullptr);
  std::locale::global(before);
  std::setlocale(LC_ALL, of_c.c_str());
}

}  // namespace

DecimalPoint::DecimalPoint() {
  {
    ReplacedLocale& shared = replaced_locale();
    const std::lock_guard lock(shared.mutex);
    if (shared.count++ == 0) {
      shared.before = std::locale();
      if (shared.before != std::locale::classic()) std::locale::global(make_nameless_classic());
    }
  }
  numbers_ = ::newlocale(LC_NUMERIC_MASK, "C", ::duplocale(::uselocale(nullptr)));
  before_ = numbers_ == nullptr ? nullptr : ::uselocale(numbers_);
}

DecimalPoint::~DecimalPoint() {
  if (before_ != nullptr) ::uselocale(before_);
  if (numbers_ != nullptr) ::freelocale(numbers_);
  ReplacedLocale& shared = replaced_locale();
  const std::lock_guard lock(shared.mutex);
  if (--shared.count == 0 && shared.before != std::locale::classic()) restore(shared.before);
}

}  // namespace core
}  // namespace trocar
