#pragma once

#include <cstdint>
#include <memory>

#include "devices/pointer/pointer_device.h"

namespace trocar::devices {

/// State of a gamepad's sticks, triggers and buttons. Sticks -1..1: x to the right, y towards the user (as in SDL);
/// triggers 0..1.
struct GamepadState {
  double left_x = 0.0;
  double left_y = 0.0;
  double right_x = 0.0;
  double right_y = 0.0;
  double left_trigger = 0.0;
  double right_trigger = 0.0;
  bool is_left_shoulder = false;
  bool is_right_shoulder = false;
  bool is_up = false;         ///< D-pad up.
  bool is_down = false;       ///< D-pad down.
  std::uint32_t buttons = 0;  ///< A main, B second, X and Y the next two bits.
};

inline constexpr double kStickDeadZone = 0.24;        ///< Share of full deflection. Source: XInput's 7849 of 32767.
inline constexpr double kTriggerDeadZone = 0.12;      ///< Source: XInput's 30 of 255.
inline constexpr double kStickExponent = 2.0;         ///< 1: linear; above 1: finer near the middle. [assumed]
inline constexpr double kPadSpeed_mm_per_s = 60.0;    ///< Sideways, away and up. Range 10..200. [assumed]
inline constexpr double kPadInward_mm_per_s = 25.0;   ///< Along the needle. Range 5..100. [assumed]
inline constexpr double kPadTilt_rad_per_s = 0.6;     ///< Range 0.1..2. [assumed]
inline constexpr double kPadTurning_rad_per_s = 1.5;  ///< About the needle. Range 0.2..4. [assumed]
inline constexpr double kRumbleFrom_n = 0.3;          ///< Forces below this are not rendered. [assumed]
inline constexpr double kRumbleFull_n = 6.0;          ///< From this force on, the motors run at full power. [assumed]

/// Left stick: sideways and away. D-pad: up and down. Right stick: swings the tip in the direction of the stick.
/// Triggers: along the needle, right in, left out. Shoulders: turn the bevel, right clockwise as seen from the hub.
/// Non-finite values count as the middle. Real-time safe.
PointerMotion gamepad_motion(const GamepadState& state) noexcept;

/// Power of the rumble motors, 0..1: linear from kRumbleFrom_n to kRumbleFull_n. Real-time safe.
double rumble_power(double force_n) noexcept;

/// Source for the first gamepad that SDL supports. Only one per process.
std::unique_ptr<PointerSource> make_gamepad_source();

}  // namespace trocar::devices
