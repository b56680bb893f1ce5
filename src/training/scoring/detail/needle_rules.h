#pragma once

#include <optional>

#include "metrics/worst_bevel.h"
#include "scoring/score.h"

namespace trocar::scoring {

/// Time at which the tip came into the target above the level that the task permits (tasks::EntryLevel); empty: it did
/// not, or task or patient have no such level. The level is the height (z) of the structure's centroid.
std::optional<double> entered_too_high_s(const AttemptData& attempt);

/// The bevel at the worst puncture of the layer whose fibres it has to part; empty: see metrics::WorstBevel.
std::optional<metrics::WorstBevel::Puncture> judge_bevel(const AttemptData& attempt);

/// Distance that the tip lacks to what the target keeps from a landmark (Task::target_away_mm), mm; 0: none.
double missing_away_mm(const AttemptData& attempt, const Vec3& tip_P);

}  // namespace trocar::scoring
