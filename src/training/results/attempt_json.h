#pragma once

#include "config/json_fwd.h"
#include "results/attempt.h"
#include "results/proficiency.h"

namespace trocar::results {

/// An attempt as lists show it, on the command line and on the pages: id, sequence, task, patient, difficulty, level,
/// started_s (since 1970), state, score, passed (null before it has ended), duration_s, station. What is not known is
/// null.
config::Json attempt_json(const Attempt& attempt);
/// The attempts of a learning curve, in its order: n from 1, attempt, started_s, patient, difficulty, score, passed,
/// moving_mean.
config::Json curve_points_json(const LearningCurve& curve);

}  // namespace trocar::results
