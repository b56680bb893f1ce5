#pragma once

#include <filesystem>

namespace trocar {
inline namespace core {

/// The folder of the shipped tables (tissues, needles, tasks): $TROCAR_DATA_DIR, else data/ found upwards from the
/// program's own place or share/trocar beside it. Empty when there is none.
std::filesystem::path data_dir();

}  // namespace core
}  // namespace trocar
