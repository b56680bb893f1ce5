#pragma once

#include <string_view>
#include <vector>

namespace trocar::config {

/// The candidate that is closest to a misspelled word, empty when none is similar.
std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& candidates);

}  // namespace trocar::config
