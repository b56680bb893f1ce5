#pragma once

#include <cstdint>

#include "telemetry/tick_sample.h"

namespace trocar::telemetry {

/// The event that reports a limit.
constexpr TickEvent limit_event(LimitReason reason) noexcept {
  return {EventKind::kLimit, static_cast<std::uint8_t>(reason)};
}

/// Puts an event into the first free entry of a sample; false if there is none. Real-time safe.
bool add_event(TickSample& sample, TickEvent event) noexcept;

}  // namespace trocar::telemetry
