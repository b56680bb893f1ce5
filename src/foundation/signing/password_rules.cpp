#include "signing/password_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "core/ascii.h"
#include "core/utf8.h"
#include "signing/common_words.h"

namespace trocar::signing {
namespace {

constexpr std::size_t kShortestRow = 5;      ///< Neighbouring keys.
constexpr std::size_t kLongestRepeated = 6;  ///< Bytes of a text that is repeated.
constexpr std::size_t kFewCharacters = 4;    ///< Beside rows of keys.
constexpr std::string_view kWhere = "password";

/// A lower-case letter, or a byte of a letter of another alphabet.
bool is_in_words(char c) {
  return (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80;
}

/// Digits and symbols that stand for a letter.
char letter_of(char c) {
  constexpr std::string_view kSymbols = "@40013!5$7+8", kLetters = "aaooiieisstt";
  static_assert(kSymbols.size() == kLetters.size());
  const std::size_t at = kSymbols.find(c);
  return at == std::string_view::npos ? c : kLetters[at];
}

/// Whether `text` starts with a word, where digits and symbols may stand for letters.
bool starts_with_word(std::string_view text, std::string_view word) {
  if (text.size() < word.size()) return false;
  return std::equal(word.begin(), word.end(), text.begin(), [](char w, char c) { return w == c || w == letter_of(c); });
}

/// Whether `text` is common words in a row, between digits and symbols, or has few characters and no letter. A letter
/// of another alphabet is in no word.
bool is_of_common_words(std::string_view text) {
  std::vector<bool> is_reached(text.size() + 1, false), has_word(text.size() + 1, false);
  is_reached[0] = true;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (!is_reached[at]) continue;
    if (!is_in_words(text[at])) {
      is_reached[at + 1] = true;
      if (has_word[at]) has_word[at + 1] = true;
    }
    for (const std::string_view word : kCommonWords) {
      if (!starts_with_word(text.substr(at), word)) continue;
      is_reached[at + word.size()] = true;
      has_word[at + word.size()] = true;
    }
  }
  return is_reached.back() && (has_word.back() || text.size() <= kFewCharacters);
}

bool is_repeated(std::string_view text) {
  for (std::size_t length = 1; length <= kLongestRepeated && 2 * length <= text.size(); ++length) {
    bool is_same = true;
    for (std::size_t n = length; n < text.size() && is_same; ++n) is_same = text[n] == text[n - length];
    if (is_same) return true;
  }
  return false;
}

/// Length of the longest row of keys, in either direction, at the start of `text`.
std::size_t row_at(std::string_view text) {
  std::size_t longest = 0;
  for (const std::string_view row : kKeyRows) {
    const std::string backward(row.rbegin(), row.rend());
    for (const std::string_view keys : {row, std::string_view(backward)})
      for (std::size_t begin = 0; begin < keys.size(); ++begin) {
        std::size_t n = 0;
        while (n < text.size() && begin + n < keys.size() && text[n] == keys[begin + n]) ++n;
        longest = std::max(longest, n);
      }
  }
  return longest;
}

/// `text` without its rows of keys.
std::string without_rows(std::string_view text) {
  std::string rest;
  while (!text.empty()) {
    const std::size_t row = row_at(text);
    if (row < kShortestRow) rest += text.front();
    text.remove_prefix(row < kShortestRow ? 1 : row);
  }
  return rest;
}

/// Number of code points; -1: not UTF-8.
int count_code_points(std::string_view text) {
  int count = 0;
  while (!text.empty()) {
    const auto character = first_character(text);
    if (!character) return -1;
    text.remove_prefix(character->bytes);
    ++count;
  }
  return count;
}

/// Whether a password is only the name of its account, alone, repeated, or with digits and symbols around it.
bool is_account_name(const std::string& password, const std::string& account) {
  if (account.empty()) return false;
  std::string rest = password;
  for (auto at = rest.find(account); at != std::string::npos; at = rest.find(account)) rest.erase(at, account.size());
  return rest.size() < password.size() && std::none_of(rest.begin(), rest.end(), is_in_words);
}

}  // namespace

bool is_common_password(std::string_view password) {
  const std::string lower = ascii::lower_case(password);
  const std::string rest = without_rows(lower);
  return is_repeated(lower) || is_of_common_words(rest) || is_of_common_words(lower);
}

Status check_new_password(std::string_view password, std::string_view account) {
  const int characters = count_code_points(password);
  if (characters < 0) return fail_usage("the password is not valid UTF-8", std::string(kWhere), "type it again");
  if (characters < kShortestPassword)
    return fail_usage("the password is too short", std::string(kWhere),
                      fmt::format("use at least {} characters, such as four words", kShortestPassword));
  if (characters > kLongestPassword)
    return fail_usage("the password is too long", std::string(kWhere),
                      fmt::format("use at most {} characters", kLongestPassword));
  if (is_account_name(ascii::lower_case(password), ascii::lower_case(account)))
    return fail_usage("the password is the name of the account", std::string(kWhere),
                      "choose one that others cannot guess");
  if (is_common_password(password))
    return fail_usage("the password is one of those that are tried first", std::string(kWhere),
                      "choose four words that do not belong together");
  return {};
}

Status check_new_pin(std::string_view pin) {
  const bool has_only_digits = std::all_of(pin.begin(), pin.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!has_only_digits || pin.size() < kShortestPin || pin.size() > kLongestPin)
    return fail_usage(fmt::format("a PIN has {} to {} digits", kShortestPin, kLongestPin), "PIN", "choose another one");
  if (pin.find_first_not_of(pin.front()) == std::string_view::npos)
    return fail_usage("the PIN has one digit only", "PIN", "use different digits");
  return {};
}

}  // namespace trocar::signing
