#pragma once

namespace trocar::testing {

/// Time between two ticks of a device at 1 kHz.
inline constexpr double kDt_s = 0.001;

}  // namespace trocar::testing
