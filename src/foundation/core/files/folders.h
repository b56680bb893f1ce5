#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// The folder of the shipped tables (tissues, needles, tasks): $TROCAR_DATA_DIR, else data/ in a parent folder of the
/// program, or share/trocar beside it. Empty if none exists.
std::filesystem::path data_dir();

/// data_dir(); if it is empty, an error that explains how to set the folder.
Result<std::filesystem::path> checked_data_dir();

}  // namespace core
inline namespace core {

/// $XDG_STATE_HOME/trocar, else ~/.local/state/trocar: data that must survive a crash.
std::filesystem::path user_state_folder();
/// $XDG_CONFIG_HOME/trocar, else ~/.config/trocar: data that the user saved for later use.
std::filesystem::path user_config_folder();
/// $XDG_CACHE_HOME/trocar, else ~/.cache/trocar: data that can be regenerated.
std::filesystem::path user_cache_folder();
/// $XDG_DATA_HOME/trocar, else ~/.local/share/trocar: data of the user that the program keeps, such as results.
std::filesystem::path user_data_folder();

}  // namespace core
inline namespace core {

/// A new empty folder in the system's folder for temporary files. The destructor removes it with its contents. Aborts
/// if the folder cannot be created.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
  bool is_empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::filesystem::path path_;
};

}  // namespace core
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
