#pragma once

#include <functional>

#include "metrics/metric.h"
#include "storage/session_file.h"

namespace trocar::storage {

/// Visits every tick of a session as a moment, in order: needle, forces and events of the tick with the newest
/// transducer and X-ray sample up to it. The first tick after an interruption, and after damaged ticks, is marked as
/// paused. Depth, resistance and events are those recorded.
void walk_moments(const Session& session, const std::function<void(const metrics::Moment&)>& visit);

/// What a session itself says about its recording: names of layers, time of the shot, image plane, and its plan as an
/// expert path. Task, patient and needle stay empty.
metrics::MetricContext context_of(const Session& session);

}  // namespace trocar::storage
