#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.h"

namespace trocar {
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
}  // namespace trocar
