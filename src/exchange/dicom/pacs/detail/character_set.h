#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace trocar::dicom::detail {

/// How the bytes of a text are read. Other character sets than these are read as ASCII, so that their other characters
/// are refused and never misread.
enum class Repertoire { kAscii, kLatin1, kUtf8 };

/// True for a value of SpecificCharacterSet that DICOM defines (PS3.3, C.12.1.1.2).
bool is_character_set(std::string_view value);
Repertoire repertoire_of(std::string_view value);

/// The characters of a text. Empty: control characters (escape sequences of ISO 2022, too), bytes that the repertoire
/// does not have, malformed UTF-8.
std::optional<std::u32string> decoded(std::string_view text, Repertoire repertoire);

/// Letters of ASCII and Latin-1; false for all others.
bool is_latin_letter(char32_t c) noexcept;
bool is_latin_capital(char32_t c) noexcept;
/// Small letters of these; other characters as they are.
char32_t latin_lower_case(char32_t c) noexcept;

/// True for elements whose value names a person.
bool is_name_of_person(std::uint32_t tag) noexcept;

/// What all spellings of a word have in common: "fus" for "Fuß", "FUSS" and the full-width "Ｆｕß", "muler" for
/// "Müller", "MUELLER" and "Muller", the same for "arm" and "arms". Other words may have it, too: they are taken for
/// the same.
std::string spelling_of(std::u32string_view word);

/// The words of the names of one object that could be on the list of harmless words: a person can have the name of an
/// organ.
class IdentityWords {
 public:
  /// Adds the words of a name. Words in other scripts than Latin are left out: they are on no list.
  void add(std::string_view name, Repertoire repertoire);
  /// True for any spelling of a word of a name, its plural, and the word that it is the plural of.
  bool has(std::u32string_view word) const { return words_.contains(spelling_of(word)); }

 private:
  void add_characters(std::u32string_view characters);

  std::set<std::string> words_;  ///< Their spelling_of().
};

}  // namespace trocar::dicom::detail
