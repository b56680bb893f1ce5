#pragma once

#include <string>
#include <string_view>

#include "config/json_fwd.h"
#include "core/result.h"
#include "scoring/score.h"

namespace trocar::storage {

/// What an attempt came to, for session files, seals of exams and the command line: score (null, with not_scored, if
/// there is none), target_reached, passed, fails, parts, harms, risks_touched, cores, bleeding (null: no biopsy).
config::Json outcome_json(const scoring::Outcome& outcome);
config::Json core_json(const scoring::BiopsyCore& core);

}  // namespace trocar::storage

namespace trocar::storage::detail {

/// An outcome as one JSON object. Numbers that are not finite become null, and NaN when read.
std::string outcome_to_json(const scoring::Outcome& outcome);
/// Reads it back; `where` is for the message.
Result<scoring::Outcome> outcome_from_json(std::string_view text, const std::string& where);

}  // namespace trocar::storage::detail
