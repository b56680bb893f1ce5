#include "core/files/folders.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include "core/files/unfinished_output.h"
#include "core/result.h"

namespace trocar {
inline namespace core {
namespace fs = std::filesystem;

fs::path data_dir() {
  if (const char* named = std::getenv("TROCAR_DATA_DIR"); named != nullptr && *named != '\0') return named;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  for (fs::path folder = program.parent_path(); folder.has_relative_path(); folder = folder.parent_path()) {
    for (const fs::path& candidate : {folder / "data", folder / "share" / "trocar"}) {
      if (fs::exists(candidate / "tissues.toml", ignored)) return candidate;
    }
  }
  return {};
}

Result<fs::path> checked_data_dir() {
  fs::path folder = data_dir();
  if (folder.empty())
    return fail("the folder with Trocar's tables was not found", "TROCAR_DATA_DIR", "set it to the folder data");
  return folder;
}

}  // namespace core
inline namespace core {
namespace {

std::filesystem::path folder(const char* variable, const char* below_home) {
  const char* given = std::getenv(variable);
  // Relative paths must be ignored (XDG base directory specification).
  if (given != nullptr && std::filesystem::path(given).is_absolute()) return std::filesystem::path(given) / "trocar";
  const char* home = std::getenv("HOME");
  const std::filesystem::path base =
      home != nullptr ? std::filesystem::path(home) : std::filesystem::temp_directory_path();
  return base / below_home / "trocar";
}

}  // namespace

std::filesystem::path user_state_folder() {
  return folder("XDG_STATE_HOME", ".local/state");
}

std::filesystem::path user_config_folder() {
  return folder("XDG_CONFIG_HOME", ".config");
}

std::filesystem::path user_cache_folder() {
  return folder("XDG_CACHE_HOME", ".cache");
}

std::filesystem::path user_data_folder() {
  return folder("XDG_DATA_HOME", ".local/share");
}

}  // namespace core
inline namespace core {
namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "trocar-XXXXXX").string();
  TROCAR_CHECK(::mkdtemp(pattern.data()) != nullptr);
  path_ = pattern;
  register_unfinished_output(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  unregister_unfinished_output(path_);
}

}  // namespace core
inline namespace core {
namespace {

namespace fs = std::filesystem;

/// Sorted by name; `error` is set if the folder was not read to its end.
std::vector<fs::path> entries_of(const fs::path& folder, std::error_code& error) {
  std::vector<fs::path> entries;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    entries.push_back(entry->path());
  std::sort(entries.begin(), entries.end());
  return entries;
}

tl::unexpected<Error> cannot_list(const fs::path& folder, const std::error_code& error) {
  return fail("the folder cannot be listed: " + error.message(), folder.string(),
              "name a folder that exists, and check its permissions");
}

/// The folder was removed, or a file took its place.
bool has_vanished(const std::error_code& error) {
  return error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory;
}

bool is_real_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::symlink_status(path, ignored).type() == fs::file_type::directory;
}

Status add_tree(const fs::path& folder, int depth, const TreeOptions& options, std::vector<fs::path>& tree) {
  std::error_code error;
  for (fs::path& entry : entries_of(folder, error)) {
    const bool is_entered = depth < options.most_depth && is_real_folder(entry);
    tree.push_back(std::move(entry));
    if (!is_entered) continue;
    const fs::path below = tree.back();
    TROCAR_TRY_STATUS(add_tree(below, depth + 1, options, tree));
  }
  const bool is_skipped =
      depth > 0 && (has_vanished(error) || (options.skips_unreadable && error == std::errc::permission_denied));
  if (error && !is_skipped) return cannot_list(folder, error);
  return {};
}

}  // namespace

Result<std::vector<fs::path>> list_folder(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> entries = entries_of(folder, error);
  if (error) return cannot_list(folder, error);
  return entries;
}

Result<std::vector<fs::path>> list_tree(const fs::path& folder, const TreeOptions& options) {
  std::vector<fs::path> tree;
  TROCAR_TRY_STATUS(add_tree(folder, 0, options, tree));
  return tree;
}

}  // namespace core
}  // namespace trocar
