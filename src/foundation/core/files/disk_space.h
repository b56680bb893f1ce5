#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// Bytes that this user can still write on the file system of a folder; empty if unknown.
std::optional<std::uintmax_t> find_free_bytes(const std::filesystem::path& folder) noexcept;

/// Creates the folder if it is missing and tries to write a file in it. An error has the folder in `where` and the
/// system's reason in `what`; the caller sets `advice`.
Status make_writable_folder(const std::filesystem::path& folder);

}  // namespace core
}  // namespace trocar
