#include "dicom/pacs/detail/harmless_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "config/toml.h"

// HarmlessWords: which texts are harmless.

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

int number_of(std::u32string_view digits) {
  int number = 0;
  for (const char32_t c : digits) number = 10 * number + static_cast<int>(c - U'0');
  return number;
}

/// A number and what follows it without a gap.
struct NumberRun {
  std::size_t whole = 0;  ///< Digits before the point.
  bool has_leading_zero = false;
  bool is_day_of_year = false;  ///< "17.3": two digits, a point and a month.
  std::size_t fraction = 0;     ///< Digits behind it.
  std::u32string unit;

  explicit NumberRun(std::u32string_view run) : whole(count_digits(run)) {
    has_leading_zero = whole > 1 && run.front() == U'0';
    const int first = number_of(run.substr(0, std::min<std::size_t>(whole, 3)));
    run.remove_prefix(whole);
    if (!run.empty() && (run.front() == U'.' || run.front() == U',')) {
      fraction = count_digits(run.substr(1));
      const int second = number_of(run.substr(1, std::min<std::size_t>(fraction, 3)));
      is_day_of_year = whole == 2 && first >= 1 && first <= 31 && second >= 1 && second <= 12;
      run.remove_prefix(1 + fraction);
    }
    unit = folded(run);
  }
  /// No year, no day with its month ("17.03"), no number of a patient.
  bool is_small() const { return whole == 1 ? fraction <= 3 : whole == 2 && fraction <= 1; }
};

/// Counts numbers with the same unit and no word between them: "17 mm 3 mm 45 mm" is a date.
class UnitsInARow {
 public:
  bool is_one_too_many(const std::u32string& unit) {
    constexpr int kMost = 2;
    count_ = unit == last_ ? count_ + 1 : 1;
    last_ = unit;
    return count_ > kMost;
  }

 private:
  std::u32string last_;
  int count_ = 0;
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
  std::optional<NumberRun> bare;  // the number before, if it has no unit yet
  UnitsInARow units;
  while (true) {
    const std::u32string_view run = take_run(text);
    const bool is_number = !run.empty() && is_number_digit(run.front());
    const bool is_unit = !run.empty() && !is_number && bare && units_.contains(folded(run));
    if (bare && (is_unit ? bare->has_leading_zero : is_number || bare->is_day_of_year)) return false;
    if (run.empty()) return text.empty();
    if (!is_number) {
      if (is_unit ? units.is_one_too_many(folded(run)) : !is_listed(run, rules)) return false;
      if (!is_unit) units = {};
      bare.reset();
      continue;
    }
    NumberRun number(run);
    const bool is_code_word = rules.is_code && code_words_.contains(folded(run));
    const bool is_bare = number.unit.empty() && !is_code_word;
    if (is_bare ? !number.is_small()
                : !is_code_word && (number.whole > kDigitsWithAUnit || number.has_leading_zero ||
                                    !units_.contains(number.unit) || units.is_one_too_many(number.unit)))
      return false;
    bare = is_bare ? std::optional(std::move(number)) : std::nullopt;
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

// HarmlessWords::load: harmless_words.toml and the names of structures.

namespace trocar::dicom::detail {
namespace fs = std::filesystem;
namespace {

constexpr const char* kListFile = "harmless_words.toml";
constexpr std::size_t kShortestWordOfAStructure = 2;

/// A word of the list; `others` are the characters beside small letters that it may have.
Result<std::u32string> read_word(const std::string& text, std::u32string_view others, const config::TomlTable& table) {
  const auto word = decoded(text, Repertoire::kUtf8);
  const auto is_allowed = [&](char32_t c) {
    return others.find(c) != std::u32string_view::npos || (is_latin_letter(c) && !is_latin_capital(c));
  };
  if (!word || word->empty() || !std::ranges::all_of(*word, is_allowed))
    return fail(fmt::format("\"{}\" is no single word in small letters", text), table.where(),
                "write words such as \"liver\"");
  return *word;
}

/// All lists of a section: every key is a list of words.
template <class Use>
Status read_section(const config::TomlTable& document, std::string_view name, std::u32string_view others, Use use) {
  TROCAR_TRY(const config::TomlTable section, document.table(name));
  for (const std::string& key : section.keys()) {
    TROCAR_TRY(const std::vector<std::string> list, section.strings(key));
    for (const std::string& text : list) {
      TROCAR_TRY(std::u32string word, read_word(text, others, section));
      use(std::move(word));
    }
  }
  return {};
}

}  // namespace

Status HarmlessWords::add_list(const fs::path& file) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(file));
  TROCAR_TRY_STATUS(document.check_keys({"words", "units", "patterns", "codes"}));
  constexpr std::u32string_view kDigits = U"0123456789";
  const auto insert_into = [](Words& words) {
    return [&words](std::u32string word) { words.insert(std::move(word)); };
  };
  TROCAR_TRY_STATUS(read_section(document, "words", {}, insert_into(words_)));
  TROCAR_TRY_STATUS(read_section(document, "units", {}, insert_into(units_)));
  TROCAR_TRY_STATUS(read_section(document, "codes", kDigits, insert_into(code_words_)));
  return read_section(document, "patterns", U"#",
                      [this](std::u32string pattern) { patterns_.push_back(std::move(pattern)); });
}

void HarmlessWords::add_structure(std::string_view name) {
  std::u32string word;
  const auto finish = [&] {
    if (word.size() >= kShortestWordOfAStructure) structure_words_.insert(word);
    word.clear();
  };
  for (const char32_t c : decoded(name, Repertoire::kUtf8).value_or(std::u32string())) {
    if (is_latin_letter(c))
      word += latin_lower_case(c);
    else
      finish();
  }
  finish();
}

Status HarmlessWords::add_structures(const fs::path& data_folder) {
  TROCAR_TRY(const config::TomlTable structures, config::load_toml(data_folder / "structures.toml"));
  std::vector<std::string> names;
  const auto append = [&](const std::vector<std::string>& more) {
    names.insert(names.end(), more.begin(), more.end());
  };
  for (const char* key : {"background", "regions"}) {
    TROCAR_TRY(const std::vector<std::string> list, structures.strings(key));
    append(list);
  }
  TROCAR_TRY(const std::vector<config::TomlTable> rows, structures.tables("structures"));
  for (const config::TomlTable& row : rows) {
    TROCAR_TRY(const std::vector<std::string> list, row.strings("names"));
    append(list);
  }
  TROCAR_TRY(const config::TomlTable total, config::load_toml(data_folder / "totalsegmentator.toml"));
  TROCAR_TRY(const config::TomlTable others, config::load_toml(data_folder / "totalsegmentator_tasks.toml"));
  TROCAR_TRY(const config::TomlTable tasks, others.table("tasks"));
  std::vector<config::TomlTable> maps;
  TROCAR_TRY(maps.emplace_back(), total.table("labels"));
  for (const std::string& task : tasks.keys()) {
    TROCAR_TRY(maps.emplace_back(), tasks.table(task));
  }
  TROCAR_TRY(const config::TomlTable codes, config::load_toml(data_folder / "structure_codes.toml"));
  TROCAR_TRY(const std::vector<std::string> unused, codes.strings("unused"));
  append(unused);
  for (const char* scheme : {"SCT", "SRT"}) {
    TROCAR_TRY(maps.emplace_back(), codes.table(scheme));
  }
  for (const config::TomlTable& map : maps)
    for (const std::string& number : map.keys()) {
      TROCAR_TRY(names.emplace_back(), map.string(number));
    }
  constexpr std::string_view kMonth = "lip";  // July in Polish and Croatian: a part of a date
  for (const std::string& name : names)
    if (name != kMonth) add_structure(name);
  return {};
}

Result<HarmlessWords> HarmlessWords::load(const fs::path& data_folder) {
  HarmlessWords words;
  TROCAR_TRY_STATUS(words.add_list(data_folder / kListFile));
  TROCAR_TRY_STATUS(words.add_structures(data_folder));
  return words;
}

}  // namespace trocar::dicom::detail
