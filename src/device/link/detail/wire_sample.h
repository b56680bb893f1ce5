#pragma once

#include "link/detail/inspection.h"
#include "telemetry/tick_sample.h"

namespace trocar::link::detail {

/// Copies every field bit by bit, including NaN. `packed` may be uninitialised memory.
void write_sample(const telemetry::TickSample& sample, wire::Sample& packed) noexcept;
inline wire::Sample to_wire(const telemetry::TickSample& sample) noexcept {
  wire::Sample packed;
  write_sample(sample, packed);
  return packed;
}
/// Reads every field into `sample`. The inspection gets an error unless time, needle and device are finite and phase,
/// gate and events have known values. All other numbers are unchanged, because the record of a fault must contain them.
/// `sample` is a parameter instead of a result because a batch has hundreds of samples.
void read_sample(const wire::Sample& packed, Inspection& inspection, telemetry::TickSample& sample);

}  // namespace trocar::link::detail
