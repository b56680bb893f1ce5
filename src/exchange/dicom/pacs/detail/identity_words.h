#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "dicom/pacs/detail/character_set.h"

namespace trocar::dicom::detail {

/// True for elements whose value names a person.
bool is_name_of_person(std::uint32_t tag) noexcept;

/// The words of the names of one object that could be on the list of harmless words: a person can have the name of an
/// organ.
class IdentityWords {
 public:
  /// Adds the words of a name. Those with characters that are not on any list are left out.
  void add(std::string_view name, Repertoire repertoire);
  /// `word` in small letters.
  bool has(std::u32string_view word) const { return words_.contains(word); }

 private:
  std::set<std::u32string, std::less<>> words_;  ///< In small letters.
};

}  // namespace trocar::dicom::detail
