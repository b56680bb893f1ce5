#pragma once

#include <vector>

#include "attempt/record/attempt_replay.h"
#include "cases/open_case.h"
#include "panels/expert_path_list.h"
#include "views/view.h"

namespace trocar::trainer {

/// Distances of the tip's way in an attempt from each expert path of the case, in the case's order; empty if the needle
/// never was in the body.
std::vector<ExpertPathList::Row> compare_with_experts(const attempt::AttemptReplay& replay,
                                                      const cases::Case& the_case);
/// The nearest path of an attempt, and the others if they are shown.
ExpertPaths expert_paths_of(const attempt::AttemptReplay& replay, const cases::Case& the_case, bool has_others);

}  // namespace trocar::trainer
