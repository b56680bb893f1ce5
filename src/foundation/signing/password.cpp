#include "signing/password.h"

#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/text.h"

namespace trocar::signing {

/// Words of the passwords that people choose most, lower case, of letters alone; written for this project.
inline constexpr auto kCommonWords = std::to_array<std::string_view>({
    "abc",       "abcd",      "access",     "admin",    "administrator", "alpha",     "amanda",     "america",
    "andrew",    "angel",     "apple",      "arsenal",  "ashley",        "autumn",    "baby",       "bailey",
    "banana",    "barcelona", "baseball",   "basket",   "batman",        "biopsy",    "blink",      "blue",
    "boss",      "buster",    "butterfly",  "changeme", "charlie",       "cheese",    "chelsea",    "chocolate",
    "clinic",    "computer",  "cookie",     "daniel",   "default",       "demo",      "department", "doctor",
    "dragon",    "dream",     "family",     "flower",   "foot",          "football",  "forever",    "freedom",
    "friday",    "friends",   "fuck",       "ginger",   "girl",          "google",    "guest",      "hannah",
    "harley",    "hello",     "hockey",     "hospital", "hunter",        "iloveyou",  "instructor", "internet",
    "jennifer",  "jessica",   "jesus",      "jordan",   "joshua",        "justin",    "killer",     "letmein",
    "liverpool", "login",     "lord",       "love",     "lovely",        "maggie",    "master",     "matrix",
    "matthew",   "medicine",  "merlin",     "michael",  "michelle",      "monday",    "money",      "monkey",
    "mother",    "mustang",   "my",         "needle",   "nicole",        "ninja",     "nurse",      "orange",
    "pass",      "passcode",  "passphrase", "passwd",   "password",      "patient",   "pepper",     "pokemon",
    "princess",  "private",   "purple",     "ranger",   "red",           "robert",    "root",       "samsung",
    "secret",    "secure",    "security",   "server",   "shadow",        "simulator", "snoopy",     "soccer",
    "spring",    "starwars",  "student",    "summer",   "sunday",        "sunshine",  "super",      "superman",
    "sweet",     "system",    "teacher",    "temp",     "test",          "testing",   "the",        "thomas",
    "thunder",   "tigger",    "trainee",    "trainer",  "training",      "trocar",    "trustno",    "user",
    "welcome",   "whatever",  "winter",     "you",      "your",
});

/// Rows of keys, and the alphabet: five or more neighbours in either direction are a row.
inline constexpr auto kKeyRows = std::to_array<std::string_view>({
    "abcdefghijklmnopqrstuvwxyz",
    "01234567890123456789",
    "qwertyuiop",
    "asdfghjkl",
    "zxcvbnm",
    "qwertzuiop",
    "yxcvbnm",
    "azertyuiop",
    "qsdfghjklm",
    "wxcvbn",
    "1qaz2wsx3edc4rfv5tgb6yhn7ujm",
    "qazwsxedcrfvtgbyhnujm",
    "1q2w3e4r5t6y7u8i9o0p",
});

namespace {

constexpr PasswordWork kMostWork{10, std::size_t{1} << 30};
constexpr std::string_view kParameters = "$argon2id$v=19$m=";  // memory in KiB, then ",t=PASSES,p=1$"

/// The number at the start of `text`, which is shortened by it and by `behind`.
template <class Number>
std::optional<Number> take_number(std::string_view& text, std::string_view behind) {
  const auto number = find_leading_number<Number>(text);
  if (!number || !number->rest.starts_with(behind)) return std::nullopt;
  text = number->rest.substr(behind.size());
  return number->value;
}

std::optional<PasswordWork> find_work(std::string_view hash) {
  if (!hash.starts_with(kParameters)) return std::nullopt;
  hash.remove_prefix(kParameters.size());
  const auto kibibytes = take_number<std::size_t>(hash, ",t=");
  if (!kibibytes || *kibibytes > kMostWork.memory_bytes / 1024) return std::nullopt;
  const auto passes = take_number<unsigned long long>(hash, ",p=1$");
  if (!passes || *passes > kMostWork.passes) return std::nullopt;
  return PasswordWork{*passes, *kibibytes * 1024};
}

}  // namespace

Result<std::string> hash_password(std::string_view password, const PasswordWork& work) {
  if (sodium_init() < 0) return fail("cryptography cannot be used", "libsodium", "reinstall libsodium");
  std::array<char, crypto_pwhash_STRBYTES> hash{};
  if (crypto_pwhash_str_alg(hash.data(), password.data(), password.size(), work.passes, work.memory_bytes,
                            crypto_pwhash_ALG_ARGON2ID13) != 0)
    return fail("there is not enough memory to hash a password", "Argon2id", "end other programs and try again");
  return std::string(hash.data());
}

bool is_password(std::string_view hash, std::string_view password) {
  if (sodium_init() < 0 || hash.size() >= crypto_pwhash_STRBYTES || !find_work(hash)) return false;
  const std::string terminated(hash);
  return crypto_pwhash_str_verify(terminated.c_str(), password.data(), password.size()) == 0;
}

bool needs_rehash(std::string_view hash, const PasswordWork& work) {
  const auto found = find_work(hash);
  return !found || found->passes != work.passes || found->memory_bytes != work.memory_bytes;
}

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
