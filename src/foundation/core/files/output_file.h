#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// Writes a file completely or not at all: `write` fills a temporary file next to `target` (same ending), which is
/// flushed to disk and renamed. On failure the temporary file is removed and an existing target is unchanged.
Status write_atomically(const std::filesystem::path& target,
                        const std::function<Status(const std::filesystem::path& temporary)>& write);

/// Writes the bytes of a text or binary file completely or not at all. The error message names a full disk.
Status write_file_atomically(const std::filesystem::path& target, std::string_view bytes);

/// The same for a folder: `write` fills an empty temporary folder beside `target`, which is then renamed to it. An
/// existing target is an error (exit status 2) unless it is an empty folder: user data is never overwritten. Temporary
/// folders that killed processes left for this target are removed.
Status write_folder_atomically(const std::filesystem::path& target,
                               const std::function<Status(const std::filesystem::path& temporary)>& write);

/// Creates the parent folder of `target` if it does not exist.
Status make_parent_folder(const std::filesystem::path& target);

/// The whole file, at most `max_bytes` long.
Result<std::string> read_file(const std::filesystem::path& path, std::size_t max_bytes = std::size_t{1} << 30);

}  // namespace core
inline namespace core {

/// Writes a new file for this user alone (mode 0600), which no other user can read at any time, and flushes it to disk.
/// Error: the file exists, or it cannot be written.
Status write_private_file(const std::filesystem::path& file, std::string_view text);
/// Error: no such file; other users may read or write it; it belongs to another user; check_folders_of() fails.
Status check_private_file(const std::filesystem::path& file);

/// Checks that no other user can replace a file: its folder and those above, and those of the file that a link names,
/// belong to this user or root and are not writable by their group or by others, unless they are sticky (as /tmp is).
/// Error: no such file; a folder of which this is not true.
Status check_folders_of(const std::filesystem::path& file);

}  // namespace core
inline namespace core {

/// Checks before long work that a file or folder can be created at `target`: creates and removes a small file in the
/// nearest existing parent folder. Detects a full disk, a read-only file system and a name that is too long.
Status check_can_write(const std::filesystem::path& target);

}  // namespace core
}  // namespace trocar
