#pragma once

#include <string>
#include <string_view>

namespace trocar::anatomy {

/// Display name of a structure with the side in front: "rib_right_10" -> "right rib 10".
std::string structure_words(std::string_view name);
/// Display name of a pierced layer: "muscle" -> "muscle fascia", "vessel" -> "vessel wall"; other names are unchanged.
std::string layer_words(std::string_view layer);
/// Order of names in a list: by letters, numbers in them by their value ("rib_left_5" before "rib_left_10").
bool is_name_before(std::string_view a, std::string_view b) noexcept;

}  // namespace trocar::anatomy
