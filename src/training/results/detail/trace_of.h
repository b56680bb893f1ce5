#pragma once

#include "results/attempt.h"
#include "storage/session_file.h"

namespace trocar::results::detail {

/// A session at kTraceRate_hz: place and depth at the end of each interval, and the force of the interval that is
/// farthest from zero, so that the peak of a puncture stays visible.
inline constexpr double kTraceRate_hz = 25.0;
Trace trace_of(const storage::Session& session);

}  // namespace trocar::results::detail
