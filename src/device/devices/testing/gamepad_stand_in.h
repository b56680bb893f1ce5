#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "core/files/folders.h"

namespace trocar::testing {

inline constexpr const char* kGamepadVariable = "TROCAR_STANDIN_GAMEPAD";

/// State of a gamepad, in memory shared by a test and the program that polls the gamepad. Axes as in SDL.
struct GamepadControls {
  std::atomic<std::int32_t> is_plugged;
  std::array<std::atomic<std::int32_t>, 6> axes;
  std::atomic<std::int32_t> strongest_rumble;  ///< Largest value since the beginning, 0..65535.
};

/// A gamepad for programs that are started during the lifetime of this object. The environment makes them load the
/// stand-in library, which provides SDL's virtual joystick. Initially all controls are released.
class GamepadStandIn {
 public:
  explicit GamepadStandIn(bool is_plugged = true);
  ~GamepadStandIn();
  GamepadStandIn(const GamepadStandIn&) = delete;
  GamepadStandIn& operator=(const GamepadStandIn&) = delete;

  void plug(bool is_plugged) { controls_->is_plugged = is_plugged; }
  void pull_right_trigger(double share);            ///< 0: released, 1: fully pulled. It moves the needle inward.
  void push_left_stick(double right, double away);  ///< -1..1
  int strongest_rumble() const { return controls_->strongest_rumble; }

 private:
  TemporaryFolder folder_;
  GamepadControls* controls_ = nullptr;
};

}  // namespace trocar::testing
