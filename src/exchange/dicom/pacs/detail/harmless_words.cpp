// HarmlessWords: which texts are harmless. Its files are read by load_harmless_words.cpp.
#include "dicom/pacs/detail/harmless_words.h"

#include <algorithm>

namespace trocar::dicom::detail {

/// What a text is compared with.
struct HarmlessWords::Rules {
  const IdentityWords* names = nullptr;  ///< Null: codes have none.
  TextUse use = TextUse::kDescription;
  bool is_code = false;
};

namespace {

constexpr std::size_t kLongestText = 1024;   ///< Bytes; a longer text is no description.
constexpr std::size_t kDigitsAtTheEnd = 2;   ///< "liver12"
constexpr std::size_t kDigitsWithAUnit = 4;  ///< "1000ms"

bool is_number_digit(char32_t c) {
  return c >= U'0' && c <= U'9';
}

bool is_of_word(char32_t c) {
  return is_number_digit(c) || is_latin_letter(c);
}

/// Printable characters of ASCII that are neither letters nor digits.
bool is_between_words(char32_t c) {
  return c < 0x80 && !is_of_word(c);
}

std::size_t count_digits(std::u32string_view text) {
  return static_cast<std::size_t>(std::ranges::find_if_not(text, is_number_digit) - text.begin());
}

std::u32string folded(std::u32string_view text) {
  std::u32string small(text);
  for (char32_t& c : small) c = latin_lower_case(c);
  return small;
}

/// Takes the next word off the text, with the decimal point of a number: "B30f", "3.0mm". Empty: none is left, or a
/// character that is neither a letter nor between words.
std::u32string_view take_run(std::u32string_view& text) {
  const auto begin = std::ranges::find_if_not(text, is_between_words) - text.begin();
  text.remove_prefix(static_cast<std::size_t>(begin));
  std::size_t size = count_digits(text);
  const bool has_fraction = size > 0 && size + 1 < text.size() && (text[size] == U'.' || text[size] == U',') &&
                            is_number_digit(text[size + 1]);
  if (has_fraction) size += 1 + count_digits(text.substr(size + 1));
  while (size < text.size() && is_of_word(text[size])) ++size;
  const std::u32string_view run = text.substr(0, size);
  text.remove_prefix(size);
  return run;
}

/// A number and what follows it without a gap.
struct NumberRun {
  std::size_t whole = 0;     ///< Digits before the point.
  std::size_t fraction = 0;  ///< Digits behind it.
  std::u32string unit;

  explicit NumberRun(std::u32string_view run) : whole(count_digits(run)) {
    run.remove_prefix(whole);
    if (!run.empty() && (run.front() == U'.' || run.front() == U',')) {
      fraction = count_digits(run.substr(1));
      run.remove_prefix(1 + fraction);
    }
    unit = folded(run);
  }
  /// No year, no day with its month ("17.03"), no number of a patient.
  bool is_small() const { return whole == 1 ? fraction <= 3 : whole == 2 && fraction <= 1; }
};

/// '#' stands for one or two digits.
bool matches(std::u32string_view pattern, std::u32string_view word) {
  if (pattern.empty()) return word.empty();
  if (word.empty()) return false;
  if (pattern.front() != U'#') return pattern.front() == word.front() && matches(pattern.substr(1), word.substr(1));
  const std::size_t digits = count_digits(word);
  return digits >= 1 && digits <= 2 && matches(pattern.substr(1), word.substr(digits));
}

/// Where a capital letter begins another word: "SpinalCord" before C, "CTThorax" before the second T.
std::vector<std::u32string_view> joined_words(std::u32string_view run) {
  std::vector<std::u32string_view> words;
  std::size_t begin = 0;
  for (std::size_t n = 1; n < run.size(); ++n) {
    const bool is_after_small = !is_latin_capital(run[n - 1]);
    const bool is_before_small = n + 1 < run.size() && is_latin_letter(run[n + 1]) && !is_latin_capital(run[n + 1]);
    if (!is_latin_capital(run[n]) || !(is_after_small || is_before_small)) continue;
    words.push_back(run.substr(begin, n - begin));
    begin = n;
  }
  words.push_back(run.substr(begin));
  return words;
}

/// Directions towards the patient: "L", "LA", "LPH".
bool is_direction(std::u32string_view run) {
  constexpr std::u32string_view kLetters = U"APLRHF";
  return run.size() <= 3 &&
         std::ranges::all_of(run, [&](char32_t c) { return kLetters.find(c) != std::u32string_view::npos; });
}

}  // namespace

bool HarmlessWords::is_listed_word(std::u32string_view word, const Rules& rules) const {
  const std::u32string small = folded(word);
  std::u32string_view stem = small;
  while (!stem.empty() && is_number_digit(stem.back()) && small.size() - stem.size() < kDigitsAtTheEnd)
    stem.remove_suffix(1);
  const bool is_structure = structure_words_.contains(stem);
  const bool is_known = is_structure || words_.contains(stem) || (rules.is_code && code_words_.contains(stem)) ||
                        std::ranges::any_of(patterns_, [&](const auto& pattern) { return matches(pattern, small); });
  if (!is_known) return false;
  if (rules.names == nullptr || (is_structure && rules.use == TextUse::kStructure)) return true;
  return !rules.names->has(stem) && !rules.names->has(small);
}

bool HarmlessWords::is_listed(std::u32string_view run, const Rules& rules) const {
  if (is_listed_word(run, rules) || (rules.is_code && is_direction(run))) return true;
  return std::ranges::all_of(joined_words(run), [&](std::u32string_view word) { return is_listed_word(word, rules); });
}

bool HarmlessWords::are_listed(std::u32string_view text, const Rules& rules) const {
  bool is_after_number = false;
  while (true) {
    const std::u32string_view run = take_run(text);
    if (run.empty()) return text.empty();
    if (!is_number_digit(run.front())) {
      if (!is_listed(run, rules) && !(is_after_number && units_.contains(folded(run)))) return false;
      is_after_number = false;
      continue;
    }
    const NumberRun number(run);
    const bool is_code_word = rules.is_code && code_words_.contains(folded(run));
    const bool is_bare = number.unit.empty() && !is_code_word;
    if (is_bare ? !number.is_small() || is_after_number
                : !is_code_word && (number.whole > kDigitsWithAUnit || !units_.contains(number.unit)))
      return false;
    is_after_number = is_bare;
  }
}

bool HarmlessWords::is_harmless(std::string_view text, Repertoire repertoire, TextUse use,
                                const IdentityWords& names) const {
  if (text.size() > kLongestText) return false;
  const auto characters = decoded(text, repertoire);
  return characters && are_listed(*characters, Rules{&names, use, false});
}

bool HarmlessWords::is_harmless_code(std::string_view value) const {
  if (value.size() > kLongestText) return false;
  const auto characters = decoded(value, Repertoire::kAscii);
  return characters && are_listed(*characters, Rules{nullptr, TextUse::kDescription, true});
}

}  // namespace trocar::dicom::detail
