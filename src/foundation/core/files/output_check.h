#pragma once

#include <filesystem>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// Checks before long work that a file or folder can be created at `target`: creates and removes a small file in the
/// nearest existing parent folder. Detects a full disk, a read-only file system and a name that is too long.
Status check_can_write(const std::filesystem::path& target);

}  // namespace core
}  // namespace trocar
