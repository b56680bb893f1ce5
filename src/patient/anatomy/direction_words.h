#pragma once

#include <string>

#include "geometry/vec.h"

namespace trocar::anatomy {

/// An offset in words of the patient (LPS): "6 mm towards the head and 4 mm to the patient's left"; the two largest
/// directions, the second where it is at least kSecondDirection of the first and does not round to 0.
std::string direction_words(const Vec3& offset_P, const char* unit);
/// The same for a direction without a length: "towards the head and to the patient's left".
std::string direction_words(const Vec3& direction_P);

inline constexpr double kSecondDirection = 0.4;  ///< [assumed]

}  // namespace trocar::anatomy
