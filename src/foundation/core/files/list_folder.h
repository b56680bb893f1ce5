#pragma once

#include <filesystem>
#include <vector>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// What a folder contains, files and folders, sorted by name. Only the functions of this file iterate over folders: the
/// `++` of std::filesystem's iterators throws, also if they were made with an error code. An entry may vanish at any
/// time: use the functions with an error code on it. Errors: there is no such folder, or it cannot be read to its end.
Result<std::vector<std::filesystem::path>> list_folder(const std::filesystem::path& folder);

/// The folders below a folder that list_tree() does not enter: neither links, nor those deeper than `most_depth`
/// (0: the folder itself alone).
struct TreeOptions {
  int most_depth = 32;
  bool skips_unreadable = false;  ///< true: folders below without permission are skipped; false: they are an error.
};

/// The same with all folders below; the entries of a folder follow it. Folders that vanish meanwhile are skipped.
Result<std::vector<std::filesystem::path>> list_tree(const std::filesystem::path& folder,
                                                     const TreeOptions& options = {});

}  // namespace core
}  // namespace trocar
