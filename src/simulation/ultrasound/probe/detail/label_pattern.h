#pragma once

#include <string>
#include <string_view>

namespace trocar::ultrasound::detail {

/// Normal form of a label's name or pattern for comparison: only lower case letters, digits and '*'.
std::string plain_name(std::string_view name);
/// True if a plain name matches a plain pattern; '*' matches any ending.
bool matches_pattern(std::string_view pattern, std::string_view name) noexcept;

}  // namespace trocar::ultrasound::detail
