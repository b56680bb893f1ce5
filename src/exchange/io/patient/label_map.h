#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "anatomy/known_structures.h"
#include "core/result.h"

namespace trocar::io {

/// Names that a user gives to the labels of segmentations, and the structures of data_dir().
///   base = "totalsegmentator"     names of numbers that are not in [labels]
///   ignore = [13, 14]             or ignore = ["13", "my_roi"]: labels that are ignored
///   [labels]
///   1 = "liver"                   a number in a file
///   my_roi = "liver_tumor"        the name of a mask file or segment
///   2 = "ignore"
///   "*" = "ignore"                every label without another entry
class LabelMap {
 public:
  /// "totalsegmentator", a TOML file, or empty for no names. Errors: an unusable file, no data folder.
  static Result<LabelMap> load(const std::string& label_map);

  bool is_empty() const noexcept { return by_number_.empty() && !rest_; }
  /// True if the number has its own entry, not only "*".
  bool has_number(int number) const { return by_number_.contains(number); }
  /// Structure of a number in a file, or kIgnoredStructure; empty if it has no name.
  std::optional<std::string> name_of(int number) const;
  /// Structure of a name in a file: the name itself, unless the map has an entry for it.
  std::string name_of(const std::string& name) const;
  const anatomy::KnownStructures& structures() const noexcept { return structures_; }

 private:
  Status read_entry(const std::string& key, std::string name, const std::string& where);
  anatomy::KnownStructures structures_;
  std::map<int, std::string> by_number_;
  std::map<std::string, std::string, std::less<>> by_name_;
  std::optional<std::string> rest_;
};

}  // namespace trocar::io
