#pragma once

#include <filesystem>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// The folder of the shipped tables (tissues, needles, tasks): $TROCAR_DATA_DIR, else data/ found upwards from the
/// program's own place or share/trocar beside it. Empty when there is none.
std::filesystem::path data_dir();

/// data_dir(), or an error that says how to name the folder where there is none.
Result<std::filesystem::path> checked_data_dir();

}  // namespace core
}  // namespace trocar
