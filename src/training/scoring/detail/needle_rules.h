#pragma once

#include <optional>

#include "scoring/score.h"

namespace trocar::scoring {

/// Time at which the tip came into the target above the level that the task permits (tasks::EntryLevel); empty: it did
/// not, or task or patient have no such level. The level is the height (z) of the structure's centroid.
std::optional<double> entered_too_high_s(const AttemptData& attempt);

/// The bevel at the puncture of the layer whose fibres it has to part; of several punctures the worst.
struct BevelJudgement {
  double to_fibres_deg = 0.0;  ///< 0..90, see tasks::bevel_to_fibres_deg.
  double time_s = 0.0;
};
/// Empty: the task has no such rule, the layer was not punctured, or the patient lacks the fibres.
std::optional<BevelJudgement> judge_bevel(const AttemptData& attempt);

/// Distance that the tip lacks to what the target keeps from a landmark (Task::target_away_mm), mm; 0: none.
double missing_away_mm(const AttemptData& attempt, const Vec3& tip_P);

}  // namespace trocar::scoring
