#pragma once

#include <vector>

#include "config/json_fwd.h"
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
