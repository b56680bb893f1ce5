#pragma once

#include <filesystem>

#include "core/result.h"

namespace trocar::link::detail {

/// Checks that `folder` is a folder (not a symbolic link) of this user without access for other users. Errors: it is
/// not.
Status check_private_folder(const std::filesystem::path& folder);
/// Like check_private_folder(), but makes the folder, for this user only, if it does not exist.
Status make_private_folder(const std::filesystem::path& folder);

}  // namespace trocar::link::detail
