#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar::devices {

/// Fault of a FaultyDevice.
enum class DeviceFault : std::uint8_t {
  kJitter,      ///< The position has uniform noise of `amount` mm.
  kDropped,     ///< Reads repeat the last reading.
  kNan,         ///< Poses are NaN.
  kStuck,       ///< The encoder value is frozen, but reads report new data.
  kJump,        ///< The pose is `amount` mm off.
  kDisconnect,  ///< Reads report disconnected, writes fail.
  kSlowWrite,   ///< Writes take `amount` ms.
  kSlowRead,    ///< Reads take `amount` ms.
};
const char* to_string(DeviceFault fault) noexcept;

/// Upper bound of a slow read or write, so that the server can still be stopped.
inline constexpr double kMaxSlow_ms = 2000.0;

struct ScheduledFault {
  DeviceFault fault = DeviceFault::kJitter;
  double from_s = 0.0;  ///< Since the device's first read.
  double for_s = 0.0;   ///< Infinite: the fault has no end.
  double amount = 0.0;
};

/// "nan@2.0+0.5", "jitter:0.3@1+2", "disconnect@5": KIND[:AMOUNT]@FROM_S[+FOR_S].
/// Errors (exit status 2): another format.
Result<ScheduledFault> parse_fault(std::string_view text);

}  // namespace trocar::devices
