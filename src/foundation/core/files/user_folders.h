#pragma once

#include <filesystem>

namespace trocar {
inline namespace core {

/// $XDG_STATE_HOME/trocar, else ~/.local/state/trocar: data that must survive a crash.
std::filesystem::path user_state_folder();
/// $XDG_CONFIG_HOME/trocar, else ~/.config/trocar: data that the user saved for later use.
std::filesystem::path user_config_folder();
/// $XDG_CACHE_HOME/trocar, else ~/.cache/trocar: data that can be regenerated.
std::filesystem::path user_cache_folder();
/// $XDG_DATA_HOME/trocar, else ~/.local/share/trocar: data of the user that the program keeps, such as results.
std::filesystem::path user_data_folder();

}  // namespace core
}  // namespace trocar
