#pragma once

#include <functional>

#include "metrics/metric.h"
#include "storage/session_file.h"

namespace trocar::storage {

/// Visits every tick of a session as a moment, in order: needle, forces and events of the tick with the newest
/// transducer and X-ray sample up to it. The first tick after an interruption, and after damaged ticks, is marked as
/// paused. Depth, resistance and events are those recorded.
void walk_moments(const Session& session, const std::function<void(const metrics::Moment&)>& visit);

/// What a session itself says about its recording: names of layers, times of the shots, image plane, and its plan as an
/// expert path. Task, patient, needle and end stay empty.
metrics::MetricContext context_of(const Session& session);
/// Recording time of the attempt's end (scoring/attempt_end.h); nullptr: the task is not known. Empty: the deepest
/// moment counts.
std::optional<double> end_s_of(const Session& session, const tasks::Task* task, bool is_biopsy);

}  // namespace trocar::storage
