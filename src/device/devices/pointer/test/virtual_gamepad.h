#pragma once

#include <SDL.h>

namespace trocar::testing {

/// Description of SDL's virtual joystick with the layout of a gamepad.
inline SDL_VirtualJoystickDesc gamepad_description(const char* name) {
  SDL_VirtualJoystickDesc description{};
  description.version = SDL_VIRTUAL_JOYSTICK_DESC_VERSION;
  description.type = SDL_JOYSTICK_TYPE_GAMECONTROLLER;
  description.naxes = SDL_CONTROLLER_AXIS_MAX;
  description.nbuttons = SDL_CONTROLLER_BUTTON_MAX;
  description.name = name;
  return description;
}

}  // namespace trocar::testing
