#pragma once

#include "link/detail/inspection.h"
#include "telemetry/tick_sample.h"

namespace trocar::link::detail {

/// Every field, bit for bit: NaN too. `packed` may be uninitialised memory.
void write_sample(const telemetry::TickSample& sample, wire::Sample& packed) noexcept;
inline wire::Sample to_wire(const telemetry::TickSample& sample) noexcept {
  wire::Sample packed;
  write_sample(sample, packed);
  return packed;
}
/// Time, needle and device are finite, phase, gate and events are known; else the inspection has a complaint. All other
/// numbers stay as they came, for the record of a fault must show it. Sets every field; a parameter instead of a result
/// because a batch has hundreds of samples.
void read_sample(const wire::Sample& packed, Inspection& inspection, telemetry::TickSample& sample);

}  // namespace trocar::link::detail
