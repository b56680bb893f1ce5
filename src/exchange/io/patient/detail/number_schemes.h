#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/known_structures.h"
#include "core/result.h"

namespace trocar::io::detail {

inline constexpr std::string_view kTotalSegmentator = "totalsegmentator";

/// What the label numbers of a program or of a public data set mean.
struct NumberScheme {
  std::string name;                  ///< Selects it: "totalsegmentator", "totalsegmentator:total_v1", "btcv".
  std::string words;                 ///< For messages: "TotalSegmentator 2", "BTCV".
  std::map<int, std::string> names;  ///< By number.
};

/// The scheme of this name: "totalsegmentator", "totalsegmentator:TASK" (totalsegmentator_tasks.toml), or a data set of
/// dataset_labels.toml. Errors (exit status 2, at `where`): another name; the schemes are listed.
Result<NumberScheme> load_scheme(const std::string& name, const anatomy::KnownStructures& structures,
                                 const std::string& where);

/// Those that a file without names can be taken for: TotalSegmentator 2 and 1 (task total), and all data sets. Without
/// those whose file the installation lacks.
std::vector<NumberScheme> load_comparable_schemes(const anatomy::KnownStructures& structures);

/// The names of numbers in a Caret label table, as TotalSegmentator writes it into a NIfTI header:
/// <Label Key="5" …>liver</Label>, also in <![CDATA[…]]>. Numbers that no label has (0 is the background, above
/// 255) are left out. Errors (at `where`): an entry without a number or an end, a number with two names, a name of more
/// than 200 letters or with control characters.
Result<std::map<int, std::string>> read_label_table(std::string_view xml, const std::string& where);

}  // namespace trocar::io::detail
