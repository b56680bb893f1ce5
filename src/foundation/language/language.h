#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/result.h"

namespace trocar::language {

/// Texts of one language for the English ones that the program makes: docs/languages.md. Reading is possible from
/// several threads at once.
class Language {
 public:
  /// English: every text is its own translation.
  Language() = default;
  /// Reads data/language/CODE.json. Errors: no such file, not of the form that docs/languages.md states, a translation
  /// with other places than its English text.
  static Result<Language> load(const std::filesystem::path& file);

  /// "de" for German; "en" for the source.
  const std::string& code() const noexcept { return code_; }
  /// In the language itself: "Deutsch".
  const std::string& name() const noexcept { return name_; }
  bool is_english() const noexcept { return code_ == "en"; }

  /// The text to show; what is not translated stays English.
  std::string translate(std::string_view english) const;
  /// nullopt: some words of the text have no translation. A text without letters, or of numbers with units, has one.
  std::optional<std::string> find(std::string_view english) const;

 private:
  friend class Translation;
  Status add(const std::string& english, const std::string& translated, const std::string& file);

  /// A text with places: literals and places alternate, beginning and ending with a literal, which may be empty.
  struct Pattern {
    std::vector<std::string> english;
    std::vector<std::string> translated;
    std::vector<std::size_t> order;  ///< Which place of the English text stands between the translated literals.
    std::size_t letters = 0;         ///< Of the English literals.
  };

  std::string code_ = "en";
  std::string name_ = "English";
  std::string decimal_sign_ = ".";
  std::unordered_map<std::string, std::string> texts_;
  std::vector<Pattern> patterns_;  ///< Those with the most letters first.
};

/// A language that can be chosen.
struct LanguageEntry {
  std::string code;  ///< "de".
  std::string name;  ///< "Deutsch".
};

/// English, and those of data/language whose files can be read, in the order of their codes.
std::vector<LanguageEntry> list_languages();

/// The language of that code ("en", or the name of a file in data/language). Error: there is none, with those that are.
Result<Language> load_language(const std::string& code);

/// An HTML page in that language: its texts, the values of `title`, `alt` and `aria-label`, and `lang` of the root.
/// Elements `script`, `style` and `pre`, and `<span translate="no">` stay as they are. Meant for pages that this
/// program made: comments and CDATA are not known.
std::string translate_page(const Language& language, std::string_view html);

/// What translate_page() translates, in the order of the page.
std::vector<std::string> texts_of_page(std::string_view html);

}  // namespace trocar::language
