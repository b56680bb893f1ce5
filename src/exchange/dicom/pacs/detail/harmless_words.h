#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "dicom/pacs/detail/character_set.h"

namespace trocar::dicom::detail {

/// What a text is for: names of structures may consist of words of anatomy that are names of persons, too.
enum class TextUse { kDescription, kStructure };

/// The words that an anonymised object may keep (data/harmless_words.toml, and the names of all structures that Trocar
/// knows). Whether a text is harmless is decided by what is on the list, not by what resembles a name: a name in any
/// language, character set or spelling is simply not on it.
class HarmlessWords {
 public:
  /// Errors: a file of the folder is missing or damaged, a word of the list is none.
  static Result<HarmlessWords> load(const std::filesystem::path& data_folder);

  /// True if all words of the text are on the list and its numbers are no date and no number of a patient: at most two
  /// digits before and one behind the point, or with a unit, and never two of them in a row; "17.3" and the like need a
  /// unit; no zero in front and no three in a row with one unit. Words that are part of a
  /// name in `names` are refused, except words of known structures in the name of a structure.
  bool is_harmless(std::string_view text, Repertoire repertoire, TextUse use, const IdentityWords& names) const;

  /// The same for a coded value (CS), which can also have words of DICOM's defined terms.
  bool is_harmless_code(std::string_view value) const;

 private:
  using Words = std::set<std::u32string, std::less<>>;
  struct Rules;

  Status add_list(const std::filesystem::path& file);
  Status add_structures(const std::filesystem::path& data_folder);
  void add_structure(std::string_view name);
  bool is_listed(std::u32string_view run, const Rules& rules) const;
  bool is_listed_word(std::u32string_view word, const Rules& rules) const;
  bool are_listed(std::u32string_view text, const Rules& rules) const;

  Words words_;
  Words structure_words_;  ///< Of the structures that Trocar knows.
  Words code_words_;
  Words units_;
  std::vector<std::u32string> patterns_;  ///< With '#' for one or two digits.
};

}  // namespace trocar::dicom::detail
