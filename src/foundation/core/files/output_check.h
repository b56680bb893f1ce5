#pragma once

#include <filesystem>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// Before long work: whether a file or folder can be made at `target`. Makes and removes a small file in the nearest
/// existing parent folder, so that a full disk, a read-only file system and a name that is too long are found now.
Status check_can_write(const std::filesystem::path& target);

}  // namespace core
}  // namespace trocar
