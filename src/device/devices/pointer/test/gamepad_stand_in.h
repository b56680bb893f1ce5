#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "core/files/temporary_folder.h"

namespace trocar::testing {

inline constexpr const char* kGamepadVariable = "TROCAR_STANDIN_GAMEPAD";

/// How a gamepad stands, in memory that a test shares with the program that polls it. Axes as SDL has them.
struct GamepadControls {
  std::atomic<std::int32_t> is_plugged;
  std::array<std::atomic<std::int32_t>, 6> axes;
  std::atomic<std::int32_t> strongest_rumble;  ///< Since the beginning, 0..65535.
};

/// A gamepad for programs that are started while it lives: the environment has them load the stand-in library, which
/// gives them SDL's virtual joystick. Plugged in, everything let go, at the beginning.
class GamepadStandIn {
 public:
  explicit GamepadStandIn(bool is_plugged = true);
  ~GamepadStandIn();
  GamepadStandIn(const GamepadStandIn&) = delete;
  GamepadStandIn& operator=(const GamepadStandIn&) = delete;

  void plug(bool is_plugged) { controls_->is_plugged = is_plugged; }
  void pull_right_trigger(double share);            ///< 0: let go, 1: to the stop. It pushes the needle in.
  void push_left_stick(double right, double away);  ///< -1..1
  int strongest_rumble() const { return controls_->strongest_rumble; }

 private:
  TemporaryFolder folder_;
  GamepadControls* controls_ = nullptr;
};

}  // namespace trocar::testing
