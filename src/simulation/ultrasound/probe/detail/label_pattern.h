#pragma once

#include <string>
#include <string_view>

namespace trocar::ultrasound::detail {

/// A label's name, or a pattern, as they are compared: lower case letters, digits and '*' alone.
std::string plain_name(std::string_view name);
/// Both plain; '*' ends a stem.
bool matches_pattern(std::string_view pattern, std::string_view name) noexcept;

}  // namespace trocar::ultrasound::detail
