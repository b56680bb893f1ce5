#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace trocar::architecture {

/// A line of src/modules.txt.
struct Module {
  std::string tier;  ///< Folder in src/ that contains it.
  int level = 0;     ///< Level of its tier, counted from the lowest.
  std::string name;
  std::set<std::string> uses;       ///< Modules it may include directly.
  std::set<std::string> libraries;  ///< Third-party libraries it may include.
  std::set<std::string> test_uses;  ///< Modules that only its tests may include besides.
};
using Modules = std::map<std::string, Module>;

/// Reads "[tier]" and "name : uses : libraries [: traits [: uses of tests]]" lines; `complaints` lists malformed lines,
/// repeated names and unknown traits.
Modules parse_modules(std::string_view text, std::vector<std::string>& complaints);

/// Modules that `name` may include: itself and all that its dependencies may use. Also terminates for a cycle.
std::set<std::string> reachable(const Modules& modules, const std::string& name);

/// Unknown dependencies, cycles and dependencies on a higher tier, one line each; empty if all dependencies are on
/// lower tiers.
std::vector<std::string> check_arrows(const Modules& modules);

struct Include {
  std::string header;
  bool is_quoted = false;  ///< "ours.h", else <theirs.h>.
  int line = 0;
};
std::vector<Include> parse_includes(std::string_view source);

/// Forbidden includes of one file, one line each. `path` is relative to the repository: src/TIER/MODULE/...,
/// apps/NAME/..., bench/... or tests/....
std::vector<std::string> check_includes(const Modules& modules, const std::string& path, std::string_view source);

/// The same for the folders of one program: includes of a file in `top`/FOLDER/... of a folder that `folders` (a list
/// in the same format, e.g. apps/trainer/folders.txt) does not allow. Files in `top` itself and in `top`/test/ may
/// include all.
std::vector<std::string> check_folder_includes(const Modules& folders, const std::string& top, const std::string& path,
                                               std::string_view source);

/// Errors of a module's README.md, which must have 10 to 40 lines.
std::vector<std::string> check_module_readme(const std::string& module, std::string_view text);

/// Maximum number of lines of a file; a longer file must be split.
inline constexpr int kMaxLines = 450;
int count_lines(std::string_view text);

}  // namespace trocar::architecture
