#pragma once

#include <string>
#include <string_view>

namespace trocar::anatomy {

/// A name in words, the side in front: "rib_right_10" -> "right rib 10", "liver_capsule" -> "liver capsule".
std::string structure_words(std::string_view name);
/// What gives way where a layer of the tissue list is pierced: "muscle" -> "muscle fascia", "vessel" -> "vessel wall",
/// "bile_duct" -> "bile duct wall"; others by their names.
std::string layer_words(std::string_view layer);
/// Order of names in a list: by letters, numbers in them by their value ("rib_left_5" before "rib_left_10").
bool is_name_before(std::string_view a, std::string_view b) noexcept;

}  // namespace trocar::anatomy
