#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// Bytes that this user can still write on the file system of a folder; empty: not known.
std::optional<std::uintmax_t> find_free_bytes(const std::filesystem::path& folder) noexcept;

/// Makes the folder where it is missing and tries to write a file in it. Errors: the folder in `where`, the system's
/// reason in `what`; `advice` is left to the caller.
Status make_writable_folder(const std::filesystem::path& folder);

}  // namespace core
}  // namespace trocar
