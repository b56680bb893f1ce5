#pragma once

#include <cstdint>

namespace trocar::telemetry {

/// The reason why the safety gate gives zero force until a reset. The first fault stays latched.
enum class GateFault : std::uint8_t {
  kNone,
  kNotFinite,         ///< The wrench or the device's reading was NaN, infinite or beyond all limits.
  kDeviceLost,        ///< Unplugged, or a write was refused.
  kDeviceSilent,      ///< No fresh reading for longer than max_unread_s.
  kRunaway,           ///< Faster than brake_mm_per_s for longer than max_runaway_s.
  kEncoderStuck,      ///< Force without motion by a single encoder count for longer than the caller allows.
  kLoopStalled,       ///< One period was longer than the caller allows.
  kRequested,         ///< The stop button was pressed.
  kLoopSlow,          ///< The periods were longer than the coupling allows, for max_slow_s together.
  kImpossibleMotion,  ///< The reading moved further in one period than a hand can move.
  kVibration,         ///< The device vibrated under the gate's force.
};
inline constexpr GateFault kLastGateFault = GateFault::kVibration;
const char* to_string(GateFault fault) noexcept;

/// The mode of the safety gate.
enum class GateMode : std::uint8_t {
  kOff,      ///< No forces requested: zero.
  kWaiting,  ///< Zero force until the requested force is small.
  kRising,   ///< The force ramps up.
  kOn,
  kFading,  ///< Client timeout, or forces no longer requested: ramps to zero, or is at zero.
  kFault,   ///< Latched; ramps to zero within fault_ramp_s, then zero.
  kAbsent,  ///< No gate (attempt without a server). Never a mode of the gate itself.
};
inline constexpr GateMode kLastGateMode = GateMode::kAbsent;
const char* to_string(GateMode mode) noexcept;

}  // namespace trocar::telemetry
