#include "language/language.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "config/json.h"
#include "core/files/folders.h"

namespace trocar::language {
namespace {

/// Longer texts are translated sentence by sentence only: patterns are for sentences.
constexpr std::size_t kLongest = 500;
/// Of the patterns that fit a text, those with the most letters are tried.
constexpr int kMostFitting = 12;

constexpr std::string_view kBlanks = " \n\t";
/// Marks that may end a text and are the same in every language.
constexpr std::size_t kFewMarks = 3;
constexpr std::string_view kMarks = ".:;,!?";

/// Units are the same in every language: a text of numbers and units needs no translation but its decimal sign.
constexpr std::array kUnits = {"mm",  "cm",  "m",  "N",   "mN",  "s",   "ms", "min", "h",  "Hz", "kHz",
                               "MHz", "dB",  "ml", "mJ",  "J",   "kPa", "Pa", "HU",  "G",  "kV", "mA",
                               "mAs", "mGy", "Gy", "MPa", "fps", "kg",  "MB", "GB",  "Nm", "x"};

// The functions of <cctype> depend on the locale: bytes of UTF-8 are no letters here.
bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}

bool is_letter(char c) {
  return is_upper(c) || (c >= 'a' && c <= 'z');
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

constexpr char kToOtherCase = 'a' - 'A';

/// "19 × 18 mm", "−3.5 N", "–".
bool is_quantity(std::string_view text) {
  std::string word;
  for (std::size_t n = 0; n <= text.size(); ++n) {
    if (n < text.size() && is_letter(text[n])) {
      word += text[n];
      continue;
    }
    if (!word.empty() && std::ranges::find(kUnits, word) == kUnits.end()) return false;
    word.clear();
  }
  return true;
}

/// "{12}" at `from`: its number, and the index behind it.
std::optional<std::pair<std::size_t, std::size_t>> place_at(std::string_view text, std::size_t from) {
  std::size_t end = from + 1;
  std::size_t number = 0;
  while (end < text.size() && is_digit(text[end]) && number < 100) number = 10 * number + (text[end++] - '0');
  if (end == from + 1 || end >= text.size() || text[end] != '}') return std::nullopt;
  return std::pair(number, end + 1);
}

/// Literals and the numbers of the places between them.
std::pair<std::vector<std::string>, std::vector<std::size_t>> split(std::string_view text) {
  std::vector<std::string> literals{""};
  std::vector<std::size_t> places;
  for (std::size_t n = 0; n < text.size();) {
    const auto place = text[n] == '{' ? place_at(text, n) : std::nullopt;
    if (place) {
      places.push_back(place->first);
      literals.emplace_back();
      n = place->second;
    } else {
      literals.back() += text[n++];
    }
  }
  return {literals, places};
}

/// What stands in the places; nullopt: the text does not fit. A place is never empty, and as short as possible.
std::optional<std::vector<std::string_view>> fit(const std::vector<std::string>& literals, std::string_view text) {
  if (!text.starts_with(literals.front()) || !text.ends_with(literals.back())) return std::nullopt;
  std::vector<std::string_view> places;
  std::size_t from = literals.front().size();
  for (std::size_t n = 1; n < literals.size(); ++n) {
    const bool is_last = n + 1 == literals.size();
    if (from + 1 > text.size()) return std::nullopt;
    const std::size_t at = is_last ? text.size() - literals[n].size() : text.find(literals[n], from + 1);
    if (at == std::string_view::npos || at <= from) return std::nullopt;
    places.push_back(text.substr(from, at - from));
    from = at + literals[n].size();
  }
  return places;
}

/// The end of a sentence: behind ". ", "! ", "? ", "; " or ": ", where another text follows.
std::size_t end_of_sentence(std::string_view text) {
  for (std::size_t n = 0; n + 2 < text.size(); ++n)
    if (std::string_view(".!?;:").find(text[n]) != std::string_view::npos && text[n + 1] == ' ') return n + 1;
  return std::string_view::npos;
}

/// With a capital first letter: of ASCII, or one with an accent of Latin-1 (two bytes in UTF-8: "ö", "é").
std::string capitalised(std::string text) {
  const auto byte = [&](std::size_t n) { return n < text.size() ? static_cast<unsigned char>(text[n]) : 0U; };
  if (is_letter(text.front()) && !is_upper(text.front()))
    text.front() = static_cast<char>(text.front() - kToOtherCase);
  else if (byte(0) == 0xC3 && byte(1) >= 0xA0 && byte(1) <= 0xBE && byte(1) != 0xB7)
    text[1] = static_cast<char>(byte(1) - kToOtherCase);
  return text;
}

/// "3.5" and not "0.1.0", which is a version.
std::string with_decimal_sign(std::string_view text, const std::string& sign) {
  std::string result;
  for (std::size_t n = 0; n < text.size();) {
    std::size_t end = n;
    while (end < text.size() && (is_digit(text[end]) || text[end] == '.')) ++end;
    const std::string_view run = text.substr(n, std::max<std::size_t>(end - n, 1));
    const std::size_t last = run.find_last_not_of('.');  // "3.5." at the end of a sentence
    const std::size_t point = run.find('.');
    const bool is_decimal = point != std::string_view::npos && point > 0 && last != std::string_view::npos &&
                            point < last && std::ranges::count(run.substr(0, last + 1), '.') == 1;
    if (is_decimal)
      result += std::string(run.substr(0, point)) + sign + std::string(run.substr(point + 1));
    else
      result += run;
    n += run.size();
  }
  return result;
}

Error form_error(const std::string& what, const std::string& file) {
  return {what, file, "docs/languages.md states the form of a language file"};
}

}  // namespace

Status Language::add(const std::string& english, const std::string& translated, const std::string& file) {
  auto [literals, places] = split(english);
  auto [translated_literals, order] = split(translated);
  std::vector<std::size_t> wanted(places.size());
  for (std::size_t n = 0; n < wanted.size(); ++n) wanted[n] = n;
  if (places != wanted)
    return tl::unexpected(form_error(fmt::format("the places of \"{}\" are not numbered from 0", english), file));
  std::vector<std::size_t> sorted = order;
  std::ranges::sort(sorted);
  if (sorted != wanted)
    return tl::unexpected(form_error(fmt::format("the translation of \"{}\" has other places", english), file));
  if (translated.empty() || english.empty())
    return tl::unexpected(form_error(fmt::format("\"{}\" has an empty translation", english), file));
  if (places.empty()) {
    texts_.emplace(english, translated);
    return {};
  }
  std::size_t letters = 0;
  for (const std::string& literal : literals) letters += literal.size();
  if (letters == 0) return tl::unexpected(form_error(fmt::format("\"{}\" is nothing but places", english), file));
  patterns_.push_back({std::move(literals), std::move(translated_literals), std::move(order), letters});
  return {};
}

Result<Language> Language::load(const std::filesystem::path& file) {
  TROCAR_TRY(const config::Json json, config::load_json(file));
  const auto text = [&](const char* key) {
    return json.is_object() && json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : "";
  };
  Language language;
  language.code_ = file.stem().string();
  language.name_ = text("language");
  language.decimal_sign_ = text("decimal_sign");
  if (language.name_.empty()) return tl::unexpected(form_error("\"language\" is missing", file.string()));
  if (language.decimal_sign_ != "." && language.decimal_sign_ != ",")
    return tl::unexpected(form_error("\"decimal_sign\" is neither \".\" nor \",\"", file.string()));
  if (!json.contains("texts") || !json["texts"].is_object())
    return tl::unexpected(form_error("\"texts\" is missing", file.string()));
  for (const auto& [english, translated] : json["texts"].items()) {
    if (!translated.is_string())
      return tl::unexpected(form_error(fmt::format("the translation of \"{}\" is no text", english), file.string()));
    TROCAR_TRY_STATUS(language.add(english, translated.get<std::string>(), file.string()));
  }
  std::ranges::stable_sort(language.patterns_, std::ranges::greater{}, &Pattern::letters);
  return language;
}

/// One call of translate(): the text and its parts, each looked up once.
class Translation {
 public:
  struct Found {
    std::string text;
    bool is_whole = false;  ///< Every word of it is translated.
  };
  explicit Translation(const Language& language) : language_(language) {}

  Found translated(std::string_view english) {
    if (const auto known = known_.find(english); known != known_.end()) return known->second;
    Found found = looked_up(english);
    known_.emplace(english, found);
    return found;
  }

 private:
  /// The better one of what was found so far: a whole translation, else the first one.
  class Best {
   public:
    bool is_whole_with(std::optional<Found> found) {
      if (found && (!best_ || (found->is_whole && !best_->is_whole))) best_ = std::move(found);
      return best_ && best_->is_whole;
    }
    std::optional<Found> best_;
  };

  Found looked_up(std::string_view english) {
    if (is_quantity(english)) return {with_decimal_sign(english, language_.decimal_sign_), true};
    if (const auto found = exact(english)) return {*found, true};
    Best best;
    if (best.is_whole_with(by_inner(english)) || best.is_whole_with(by_pattern(english)) ||
        best.is_whole_with(by_capital(english)) || best.is_whole_with(by_pieces(english, ", ")) ||
        best.is_whole_with(by_sentence(english)))
      return *best.best_;
    return best.best_.value_or(Found{std::string(english), false});
  }

  std::optional<std::string> exact(std::string_view english) const {
    std::string key(english);
    if (const auto found = language_.texts_.find(key); found != language_.texts_.end()) return found->second;
    // "Liver" where the catalogue has "liver": a name at the beginning of a line.
    if (!is_upper(key.front())) return std::nullopt;
    key.front() = static_cast<char>(key.front() + kToOtherCase);
    const auto found = language_.texts_.find(key);
    return found == language_.texts_.end() ? std::nullopt : std::optional(capitalised(found->second));
  }

  std::optional<Found> by_pattern(std::string_view english) {
    if (english.size() > kLongest) return std::nullopt;
    Best best;
    int fitting = 0;
    for (const Language::Pattern& pattern : language_.patterns_) {
      const auto places = fit(pattern.english, english);
      if (places && (best.is_whole_with(filled(pattern, *places)) || ++fitting == kMostFitting)) break;
    }
    return best.best_;
  }

  Found filled(const Language::Pattern& pattern, const std::vector<std::string_view>& places) {
    Found found{pattern.translated.front(), true};
    for (std::size_t n = 0; n < pattern.order.size(); ++n) {
      const Found place = translated(places[pattern.order[n]]);
      found.is_whole = found.is_whole && place.is_whole;
      found.text += place.text + pattern.translated[n + 1];
    }
    return found;
  }

  /// A pattern that begins with a small letter, at the beginning of a sentence.
  std::optional<Found> by_capital(std::string_view english) {
    if (!is_upper(english.front()) || english.size() > kLongest) return std::nullopt;
    std::string small(english);
    small.front() = static_cast<char>(small.front() + kToOtherCase);
    // The places are parts of a text that does not last.
    std::optional<Found> found = Translation(language_).by_pattern(small);
    if (!found || !found->is_whole) return std::nullopt;
    found->text = capitalised(found->text);
    return found;
  }

  /// The text without the blanks, brackets or marks around it, which stay.
  std::optional<Found> by_inner(std::string_view english) {
    const auto with_inner = [&](std::size_t before, std::size_t behind) {
      Found inner = translated(english.substr(before, english.size() - before - behind));
      inner.text =
          std::string(english.substr(0, before)) + inner.text + std::string(english.substr(english.size() - behind));
      return inner;
    };
    const std::size_t begin = english.find_first_not_of(kBlanks);
    const std::size_t behind = english.size() - 1 - english.find_last_not_of(kBlanks);
    if (begin > 0 || behind > 0) return with_inner(begin, behind);
    if (english.size() > 2 && english.starts_with('(') && english.ends_with(')')) return with_inner(1, 1);
    const std::size_t marks = english.size() - 1 - english.find_last_not_of(kMarks);
    if (marks == 0 || marks == english.size()) return std::nullopt;
    // One after the other, since "Stop." may be a text with its mark; of a long row all at once.
    return with_inner(0, marks <= kFewMarks ? 1 : marks);
  }

  std::optional<Found> by_pieces(std::string_view english, std::string_view separator) {
    const std::size_t at = english.find(separator);
    if (at == std::string_view::npos || at == 0 || at + separator.size() == english.size()) return std::nullopt;
    return joined(english, at, at + separator.size());
  }

  std::optional<Found> by_sentence(std::string_view english) {
    const std::size_t end = end_of_sentence(english);
    return end == std::string_view::npos ? std::nullopt : std::optional(joined(english, end, end));
  }

  /// Both parts of a text; what is between them stays.
  Found joined(std::string_view english, std::size_t first_end, std::size_t rest_begin) {
    const Found first = translated(english.substr(0, first_end));
    const Found rest = translated(english.substr(rest_begin));
    const std::string_view between = english.substr(first_end, rest_begin - first_end);
    return {first.text + std::string(between) + rest.text, first.is_whole && rest.is_whole};
  }

  const Language& language_;
  std::unordered_map<std::string_view, Found> known_;  ///< Parts of the text.
};

std::string Language::translate(std::string_view english) const {
  return is_english() ? std::string(english) : Translation(*this).translated(english).text;
}

std::optional<std::string> Language::find(std::string_view english) const {
  if (is_english()) return std::string(english);
  Translation::Found found = Translation(*this).translated(english);
  return found.is_whole ? std::optional(std::move(found.text)) : std::nullopt;
}

std::vector<LanguageEntry> list_languages() {
  std::vector<LanguageEntry> entries{{"en", "English"}};
  const auto files = list_folder(data_dir() / "language");
  if (!files) return entries;
  for (const std::filesystem::path& file : *files)
    if (const auto language = file.extension() == ".json" ? Language::load(file) : Result<Language>(Language());
        language)
      if (!language->is_english()) entries.push_back({language->code(), language->name()});
  return entries;
}

Result<Language> load_language(const std::string& code) {
  if (code == "en") return Language();
  const bool is_code = !code.empty() && std::ranges::all_of(code, is_letter);
  const std::filesystem::path file = data_dir() / "language" / (code + ".json");
  std::error_code ignored;
  if (is_code && std::filesystem::exists(file, ignored)) return Language::load(file);
  std::string codes;
  for (const LanguageEntry& entry : list_languages()) codes += (codes.empty() ? "" : ", ") + entry.code;
  return fail_usage(fmt::format("there is no language \"{}\"", code), "--language", "choose one of " + codes);
}

}  // namespace trocar::language
