#include "devices/pointer/gamepad_device.h"

#include <SDL.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "devices/detail/factories.h"

namespace trocar::devices {
namespace {

constexpr double kFullAxis = 32767.0;    // SDL's axes are 16 bit
constexpr double kFullRumble = 65535.0;  // and its motors
constexpr Uint32 kRumbleLasts_ms = 100;  // ends the rumble of a stalled thread

double finite_or_zero(double value) noexcept {
  return std::isfinite(value) ? value : 0.0;
}

/// 0 within the dead zone, then increasing to 1.
double deflection_response(double deflection, double dead_zone) noexcept {
  const double beyond = std::clamp((deflection - dead_zone) / (1.0 - dead_zone), 0.0, 1.0);
  return std::pow(beyond, kStickExponent);
}

struct Stick {
  double right = 0.0;
  double away = 0.0;
};

/// The dead zone is a circle, so that diagonal motion starts as smoothly as axial motion.
Stick stick(double x, double y) noexcept {
  const double right = finite_or_zero(x);
  const double away = -finite_or_zero(y);
  const double deflection = std::hypot(right, away);
  if (!(deflection > kStickDeadZone)) return {};
  const double response = deflection_response(deflection, kStickDeadZone) / deflection;
  return {response * right, response * away};
}

double difference(bool plus, bool minus) noexcept {
  return (plus ? 1.0 : 0.0) - (minus ? 1.0 : 0.0);
}

class GamepadSource final : public PointerSource {
 public:
  ~GamepadSource() override { close(); }

  std::string name() const override { return "gamepad"; }
  Status open() override;
  bool poll(PointerMotion& motion) noexcept override;
  void show_force(double force_n) noexcept override;
  void close() noexcept override;

 private:
  double axis(SDL_GameControllerAxis which) const noexcept {
    return std::max(-1.0, SDL_GameControllerGetAxis(pad_, which) / kFullAxis);
  }
  bool is_pressed(SDL_GameControllerButton which) const noexcept {
    return SDL_GameControllerGetButton(pad_, which) != 0;
  }
  GamepadState state() const noexcept;

  SDL_GameController* pad_ = nullptr;
  bool has_sdl_ = false;
};

Status GamepadSource::open() {
  // SDL would otherwise catch SIGINT and SIGTERM, and ignore input without a window.
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
  if (SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) != 0) {
    return fail("SDL finds no gamepads", SDL_GetError(), "use mouse or another device");
  }
  has_sdl_ = true;
  SDL_JoystickEventState(SDL_IGNORE);  // the event queue is not used
  SDL_GameControllerEventState(SDL_IGNORE);
  SDL_GameControllerUpdate();
  for (int i = 0; i < SDL_NumJoysticks() && pad_ == nullptr; ++i) {
    if (SDL_IsGameController(i) == SDL_TRUE) pad_ = SDL_GameControllerOpen(i);
  }
  if (pad_ != nullptr) return {};
  close();
  return fail("no gamepad is connected", "gamepad",
              "connect or pair one, check read permission for /dev/input, or use mouse");
}

bool GamepadSource::poll(PointerMotion& motion) noexcept {
  SDL_GameControllerUpdate();
  if (SDL_GameControllerGetAttached(pad_) != SDL_TRUE) return false;
  motion = gamepad_motion(state());
  return true;
}

GamepadState GamepadSource::state() const noexcept {
  GamepadState state;
  state.left_x = axis(SDL_CONTROLLER_AXIS_LEFTX);
  state.left_y = axis(SDL_CONTROLLER_AXIS_LEFTY);
  state.right_x = axis(SDL_CONTROLLER_AXIS_RIGHTX);
  state.right_y = axis(SDL_CONTROLLER_AXIS_RIGHTY);
  state.left_trigger = axis(SDL_CONTROLLER_AXIS_TRIGGERLEFT);
  state.right_trigger = axis(SDL_CONTROLLER_AXIS_TRIGGERRIGHT);
  state.is_left_shoulder = is_pressed(SDL_CONTROLLER_BUTTON_LEFTSHOULDER);
  state.is_right_shoulder = is_pressed(SDL_CONTROLLER_BUTTON_RIGHTSHOULDER);
  state.is_up = is_pressed(SDL_CONTROLLER_BUTTON_DPAD_UP);
  state.is_down = is_pressed(SDL_CONTROLLER_BUTTON_DPAD_DOWN);
  const std::uint32_t third = kButtonSecond << 1;
  if (is_pressed(SDL_CONTROLLER_BUTTON_A)) state.buttons |= kButtonMain;
  if (is_pressed(SDL_CONTROLLER_BUTTON_B)) state.buttons |= kButtonSecond;
  if (is_pressed(SDL_CONTROLLER_BUTTON_X)) state.buttons |= third;
  if (is_pressed(SDL_CONTROLLER_BUTTON_Y)) state.buttons |= third << 1;
  return state;
}

void GamepadSource::show_force(double force_n) noexcept {
  const auto power = static_cast<Uint16>(kFullRumble * rumble_power(force_n));
  if (pad_ != nullptr) SDL_GameControllerRumble(pad_, power, power, kRumbleLasts_ms);
}

void GamepadSource::close() noexcept {
  if (pad_ != nullptr) SDL_GameControllerClose(pad_);
  pad_ = nullptr;
  if (!has_sdl_) return;
  has_sdl_ = false;
  SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
  SDL_TLSCleanup();  // frees SDL's data of a thread that it did not create
}

}  // namespace

PointerMotion gamepad_motion(const GamepadState& state) noexcept {
  const Stick left = stick(state.left_x, state.left_y);
  const Stick right = stick(state.right_x, state.right_y);
  PointerMotion motion;
  motion.v_D = kPadSpeed_mm_per_s * Vec3(left.right, left.away, difference(state.is_up, state.is_down));
  motion.inward_mm_per_s =
      kPadInward_mm_per_s * (deflection_response(finite_or_zero(state.right_trigger), kTriggerDeadZone) -
                             deflection_response(finite_or_zero(state.left_trigger), kTriggerDeadZone));
  // The tip is below the grip: swinging it to the right is a rotation about -y, away from the user about +x.
  motion.w_D = kPadTilt_rad_per_s * Vec3(right.away, -right.right, 0.0);
  motion.turning_rad_per_s = kPadTurning_rad_per_s * difference(state.is_right_shoulder, state.is_left_shoulder);
  motion.buttons = state.buttons;
  return motion;
}

double rumble_power(double force_n) noexcept {
  return std::clamp((finite_or_zero(force_n) - kRumbleFrom_n) / (kRumbleFull_n - kRumbleFrom_n), 0.0, 1.0);
}

std::unique_ptr<PointerSource> make_gamepad_source() {
  return std::make_unique<GamepadSource>();
}

OpenedDevice open_gamepad(const DeviceSpec&, const DeviceOptions& options) {
  TROCAR_TRY(const stylus::DevicePreset preset, load_preset_of(options, "gamepad"));
  return PolledPointer::open(preset, make_gamepad_source());
}

}  // namespace trocar::devices
