#pragma once

#include <filesystem>

#include "core/result.h"

namespace trocar::link::detail {

/// A folder (no link to one) of this user that nobody else may enter or read. Errors: is none.
Status check_private_folder(const std::filesystem::path& folder);
/// The same; made for this user alone where there is nothing yet.
Status make_private_folder(const std::filesystem::path& folder);

}  // namespace trocar::link::detail
