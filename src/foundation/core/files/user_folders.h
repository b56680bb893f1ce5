#pragma once

#include <filesystem>

namespace trocar {
inline namespace core {

/// $XDG_STATE_HOME/trocar, else ~/.local/state/trocar: what a crash must not take along.
std::filesystem::path user_state_folder();
/// $XDG_CONFIG_HOME/trocar, else ~/.config/trocar: what the user saves to have it again.
std::filesystem::path user_config_folder();
/// $XDG_CACHE_HOME/trocar, else ~/.cache/trocar: what can be made again.
std::filesystem::path user_cache_folder();

}  // namespace core
}  // namespace trocar
