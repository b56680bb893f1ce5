#pragma once

#include <vector>

#include "config/json.h"
#include "scoring/score.h"

namespace trocar::storage {

/// The parts of a score and a biopsy core as JSON, in session files and on the command line.
config::Json parts_json(const std::vector<scoring::ScorePart>& parts);
config::Json core_json(const scoring::BiopsyCore& core);

}  // namespace trocar::storage
