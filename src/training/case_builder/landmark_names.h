#pragma once

#include <span>
#include <string_view>

namespace trocar::case_builder {

/// Common clinical names of landmarks that are visible or palpable on the skin: trunk from head to feet, then the back.
std::span<const std::string_view> landmark_names() noexcept;

}  // namespace trocar::case_builder
