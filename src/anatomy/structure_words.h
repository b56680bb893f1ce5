#pragma once

#include <string>
#include <string_view>

namespace trocar {

/// A name in words, the side in front: "rib_right_10" -> "right rib 10", "liver_capsule" -> "liver capsule".
std::string structure_words(std::string_view name);

}  // namespace trocar
