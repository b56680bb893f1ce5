#pragma once

#include "link/detail/inspection.h"
#include "telemetry/tick_sample.h"

namespace trocar::link::detail {

/// Every field, bit for bit: NaN too.
wire::Sample to_wire(const telemetry::TickSample& sample);
/// Time, needle and device are finite, phase and events are known. All other numbers stay as they came, for a record of
/// a fault must show it.
telemetry::TickSample read_sample(const wire::Sample& sample, Inspection& inspection);

}  // namespace trocar::link::detail
