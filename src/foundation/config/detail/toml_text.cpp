#include "config/detail/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/text.h"

namespace trocar::config::detail {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;  ///< Takes 35 times as much memory at most.
constexpr int kMaxTomlDepth = 32;                        ///< Nested brackets, and dots of one key.

/// Scans the text like toml++ up to the first error: text after an error is never parsed.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  /// The first fault that toml++ must not parse; empty if there is none.
  std::string find_fault() {
    int brackets = 0;
    int dots = 0;
    char before = '\n';  // the last non-blank character
    bool is_key = true;  // no value has started on this line
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        const bool is_start = std::string_view("\n=[{,").find(before) != std::string_view::npos;
        if (!is_start && !(before == '.' && is_key)) return "a quote in the middle of a word";
        before = c;
        if (!skip_string()) return "an unknown escape or a backslash at the end of a line";
        continue;
      }
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
        continue;
      }
      if (static_cast<unsigned char>(c) >= 0x80) return "a letter outside of ASCII that is not in quotes";
      if (c == '[' || c == '{') ++brackets;
      if ((c == ']' || c == '}') && brackets > 0) --brackets;
      dots = c == '.' ? dots + 1 : (c == '\n' || c == '=' || c == ',') ? 0 : dots;
      if (c == '=') is_key = false;
      if (c == '\n') is_key = brackets == 0;
      if (brackets > kMaxTomlDepth || dots > kMaxTomlDepth)
        return fmt::format("nested more than {} deep", kMaxTomlDepth);
      if (c != ' ' && c != '\t' && c != '\r') before = c;
      ++at_;
    }
    return {};
  }

  std::ptrdiff_t line() const {
    return 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
  }

 private:
  /// Moves past the string that starts here; false at an escape that is not in TOML, or at a backslash that joins
  /// lines: non-ASCII text after it is undefined behaviour in toml++.
  bool skip_string() {
    const char quote = text_[at_];
    const std::string fence(3, quote);
    const bool is_multiline = text_.substr(at_, 3) == fence;
    at_ += is_multiline ? 3 : 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\\' && quote == '"') {
        if (at_ + 1 < text_.size() && std::string_view("btnfr\"\\uU").find(text_[at_ + 1]) == std::string_view::npos)
          return false;
        at_ = std::min(at_ + 2, text_.size());
      } else if (!is_multiline && (c == quote || c == '\n')) {
        ++at_;
        return true;
      } else if (is_multiline && text_.substr(at_, 3) == fence) {
        at_ += 3;
        while (at_ < text_.size() && text_[at_] == quote) ++at_;  // quotes that are part of the content
        return true;
      } else {
        ++at_;
      }
    }
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

Status check_toml_text(std::string_view text, const std::string& name) {
  if (text.size() > kMaxBytes)
    return fail(fmt::format("configuration file of {} bytes exceeds the limit of {}", text.size(), kMaxBytes), name,
                "is this the right file?");
  int line = 1;
  for (std::size_t n = 0; n < text.size();) {
    const char c = text[n];
    const auto character = first_character(text.substr(n));
    const bool is_control = (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\r' && c != '\n') || c == 0x7f;
    if (!character || is_control)
      return fail(is_control ? "a control character in a configuration file" : "not UTF-8 text",
                  fmt::format("{}, line {}", name, line), "save the file as UTF-8 text");
    if (c == '\n') ++line;
    n += character->bytes;
  }
  Scanner scanner(text);
  if (const std::string fault = scanner.find_fault(); !fault.empty())
    return fail(fault, fmt::format("{}, line {}", name, scanner.line()), "correct the file");
  return {};
}

}  // namespace trocar::config::detail
