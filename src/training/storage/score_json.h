#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/json_fwd.h"
#include "core/result.h"
#include "scoring/score.h"

namespace trocar::storage {

/// The parts of a score, biopsy cores and the bleeding risk as JSON, in session files and on the command line.
config::Json parts_json(const std::vector<scoring::ScorePart>& parts);
/// The harm of an attempt, in the order of the outcome.
config::Json harms_json(const std::vector<metrics::HarmEvent>& harms);
config::Json core_json(const scoring::BiopsyCore& core);
config::Json cores_json(const std::vector<scoring::BiopsyCore>& cores);
config::Json bleeding_json(const scoring::Bleeding& bleeding);

}  // namespace trocar::storage

namespace trocar::storage::detail {

/// An outcome as one JSON object. Numbers that are not finite become null, and NaN when read.
std::string outcome_to_json(const scoring::Outcome& outcome);
/// Reads it back; `where` is for the message.
Result<scoring::Outcome> outcome_from_json(std::string_view text, const std::string& where);

}  // namespace trocar::storage::detail
