#include "core/files/list_folder.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace trocar {
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
