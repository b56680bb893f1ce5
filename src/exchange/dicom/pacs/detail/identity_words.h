#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "dicom/pacs/detail/character_set.h"

namespace trocar::dicom::detail {

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
