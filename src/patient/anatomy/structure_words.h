#pragma once

#include <string>
#include <string_view>

#include "geometry/vec.h"

namespace trocar::anatomy {

/// Display name of a structure with the side in front: "rib_right_10" -> "right rib 10".
std::string structure_words(std::string_view name);
/// Display name of a pierced layer: "muscle" -> "muscle fascia", "vessel" -> "vessel wall"; other names are unchanged.
std::string layer_words(std::string_view layer);
/// Order of names in a list: by letters, numbers in them by their value ("rib_left_5" before "rib_left_10").
bool is_name_before(std::string_view a, std::string_view b) noexcept;

/// An offset in words of the patient (LPS): "6 mm towards the head and 4 mm to the patient's left"; the two largest
/// directions, the second where it is at least kSecondDirection of the first and does not round to 0.
std::string direction_words(const Vec3& offset_P, const char* unit);
/// The same for a direction without a length: "towards the head and to the patient's left".
std::string direction_words(const Vec3& direction_P);

inline constexpr double kSecondDirection = 0.4;  ///< [assumed]

}  // namespace trocar::anatomy
