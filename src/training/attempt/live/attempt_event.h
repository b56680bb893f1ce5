#pragma once

#include <optional>
#include <string>

#include "attempt/live/attempt_view.h"
#include "storage/session_file.h"

namespace trocar::attempt {

/// An event of a tick for people: punctures, tissue that is entered, a needle that was resumed inside. Nothing for
/// what else the record keeps.
std::optional<AttemptEvent> describe_event(const storage::SessionInfo& info, const telemetry::TickSample& sample,
                                           const telemetry::TickEvent& event);

}  // namespace trocar::attempt
