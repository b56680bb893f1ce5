#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// Writes a new file for this user alone (mode 0600), which no other user can read at any time, and flushes it to disk.
/// Error: the file exists, or it cannot be written.
Status write_private_file(const std::filesystem::path& file, std::string_view text);
/// Error: no such file, or other users may read or write it.
Status check_private_file(const std::filesystem::path& file);

}  // namespace core
}  // namespace trocar
