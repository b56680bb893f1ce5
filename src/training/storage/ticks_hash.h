#pragma once

#include <span>
#include <string>

#include "telemetry/tick_sample.h"

namespace trocar::storage {

/// Hash of ticks as this program records them (Session::ticks_hash), also of a session whose program knew fewer fields:
/// what load_session fills in counts.
std::string hash_ticks(std::span<const telemetry::TickSample> samples);

}  // namespace trocar::storage
