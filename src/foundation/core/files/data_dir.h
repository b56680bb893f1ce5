#pragma once

#include <filesystem>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// The folder of the shipped tables (tissues, needles, tasks): $TROCAR_DATA_DIR, else data/ in a parent folder of the
/// program, or share/trocar beside it. Empty if none exists.
std::filesystem::path data_dir();

/// data_dir(); if it is empty, an error that explains how to set the folder.
Result<std::filesystem::path> checked_data_dir();

}  // namespace core
}  // namespace trocar
