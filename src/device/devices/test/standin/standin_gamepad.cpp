// Loaded before SDL (LD_PRELOAD) into a program that polls a gamepad: plugs SDL's virtual joystick in and out and moves
// it as the file named by $TROCAR_STANDIN_GAMEPAD says.
#include <SDL.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

#include "devices/pointer/test/virtual_gamepad.h"
#include "devices/testing/gamepad_stand_in.h"

namespace {

using trocar::testing::GamepadControls;

GamepadControls* controls() {
  static GamepadControls* const kControls = []() -> GamepadControls* {
    const char* path = std::getenv(trocar::testing::kGamepadVariable);
    const int file = path == nullptr ? -1 : ::open(path, O_RDWR | O_CLOEXEC);
    if (file < 0) return nullptr;
    void* memory = ::mmap(nullptr, sizeof(GamepadControls), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    ::close(file);
    return memory == MAP_FAILED ? nullptr : static_cast<GamepadControls*>(memory);
  }();
  return kControls;
}

int find_pad() {
  for (int i = 0; i < SDL_NumJoysticks(); ++i)
    if (SDL_JoystickIsVirtual(i) == SDL_TRUE) return i;
  return -1;
}

void plug_in() {
  SDL_VirtualJoystickDesc description = trocar::testing::gamepad_description("Trocar stand-in pad");
  description.Rumble = [](void*, Uint16 low, Uint16) {
    if (low > controls()->strongest_rumble) controls()->strongest_rumble = low;
    return 0;
  };
  SDL_JoystickAttachVirtualEx(&description);
}

void move(int pad) {
  SDL_Joystick* joystick = SDL_JoystickFromInstanceID(SDL_JoystickGetDeviceInstanceID(pad));
  if (joystick == nullptr) return;  // nobody has opened it
  for (int axis = 0; axis < SDL_CONTROLLER_AXIS_MAX; ++axis)
    SDL_JoystickSetVirtualAxis(joystick, axis, static_cast<Sint16>(controls()->axes[static_cast<std::size_t>(axis)]));
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void SDL_GameControllerUpdate() {
  static const auto kNext = reinterpret_cast<void (*)()>(::dlsym(RTLD_NEXT, "SDL_GameControllerUpdate"));
  if (controls() != nullptr) {
    const int pad = find_pad();
    if (controls()->is_plugged && pad < 0) plug_in();
    if (!controls()->is_plugged && pad >= 0) SDL_JoystickDetachVirtual(pad);
    if (const int now = find_pad(); now >= 0) move(now);
  }
  kNext();
}
