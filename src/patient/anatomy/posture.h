#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "geometry/vec.h"

namespace trocar::anatomy {

/// How the patient lies or sits.
enum class Posture : std::uint8_t { kSupine, kProne, kLeftLateral, kRightLateral, kSitting };

/// "supine", "prone", "left-lateral" (lying on the left side), "right-lateral", "sitting".
std::string_view posture_name(Posture posture);
std::optional<Posture> find_posture(std::string_view name);
/// "lying on the back".
std::string_view posture_words(Posture posture);
/// Direction of gravity in P (unit vector).
Vec3 gravity_P(Posture posture);

}  // namespace trocar::anatomy
