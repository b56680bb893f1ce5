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

}  // namespace trocar::io::detail
