#pragma once

#include <string>
#include <string_view>

#include "core/result.h"
#include "scoring/score.h"

namespace trocar::storage::detail {

/// An outcome as one JSON object. Numbers that are not finite become null, and NaN when read.
std::string outcome_to_json(const scoring::Outcome& outcome);
/// Reads it back; `where` is for the message.
Result<scoring::Outcome> outcome_from_json(std::string_view text, const std::string& where);

}  // namespace trocar::storage::detail
