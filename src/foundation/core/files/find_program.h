#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace trocar {
inline namespace core {

/// Whether a path is a regular file that may be executed.
bool is_program(const std::filesystem::path& path);

/// An executable by its file name: beside the running program, in TROCAR_BIN_DIR, or on PATH, in this order.
std::optional<std::filesystem::path> find_program(std::string_view name);

}  // namespace core
}  // namespace trocar
