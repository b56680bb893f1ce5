#pragma once

#include <vector>

#include "config/json.h"
#include "tasks/score.h"

namespace trocar::storage {

/// The parts of a score and a biopsy core as JSON, in session files and on the command line.
config::Json parts_json(const std::vector<tasks::ScorePart>& parts);
config::Json core_json(const tasks::BiopsyCore& core);

}  // namespace trocar::storage
