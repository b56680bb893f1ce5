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
}  // namespace trocar
