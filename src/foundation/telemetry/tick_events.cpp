#include "telemetry/tick_events.h"

namespace trocar::telemetry {

bool add_event(TickSample& sample, TickEvent event) noexcept {
  for (TickEvent& entry : sample.events) {
    if (entry.kind != EventKind::kNone) continue;
    entry = event;
    return true;
  }
  return false;
}

}  // namespace trocar::telemetry
