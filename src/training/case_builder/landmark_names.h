#pragma once

#include <span>
#include <string_view>

namespace trocar::case_builder {

/// Names of landmarks that are seen or felt on the skin, as they are said at the bedside: those of the trunk from head
/// to feet, then those of the back.
std::span<const std::string_view> landmark_names() noexcept;

}  // namespace trocar::case_builder
