#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "ultrasound/sweep/tracked_sequence.h"

namespace trocar::io::detail {

std::string_view trimmed(std::string_view text);

/// Finite numbers between white space, at most `most` of them; empty if the text contains anything else.
std::optional<std::vector<double>> find_numbers(std::string_view text, std::size_t most);

/// An affine matrix written row by row. The error (without a place) states the reason.
Result<ultrasound::TrackedSequence::Matrix4> parse_matrix(std::string_view text);

}  // namespace trocar::io::detail
