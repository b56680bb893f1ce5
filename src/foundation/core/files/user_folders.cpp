#include "core/files/user_folders.h"

#include <cstdlib>

namespace trocar {
inline namespace core {
namespace {

std::filesystem::path folder(const char* variable, const char* below_home) {
  const char* given = std::getenv(variable);
  // Relative paths must be ignored (XDG base directory specification).
  if (given != nullptr && std::filesystem::path(given).is_absolute()) return std::filesystem::path(given) / "trocar";
  const char* home = std::getenv("HOME");
  const std::filesystem::path base =
      home != nullptr ? std::filesystem::path(home) : std::filesystem::temp_directory_path();
  return base / below_home / "trocar";
}

}  // namespace

std::filesystem::path user_state_folder() {
  return folder("XDG_STATE_HOME", ".local/state");
}

std::filesystem::path user_config_folder() {
  return folder("XDG_CONFIG_HOME", ".config");
}

std::filesystem::path user_cache_folder() {
  return folder("XDG_CACHE_HOME", ".cache");
}

std::filesystem::path user_data_folder() {
  return folder("XDG_DATA_HOME", ".local/share");
}

}  // namespace core
}  // namespace trocar
