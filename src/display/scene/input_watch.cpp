#include "scene/input_watch.h"

#include <X11/Xlib.h>

#include <algorithm>
#include <array>

// Xlib's macros (Status, None, Bool) conflict with other headers: it comes last.

namespace trocar::scene {
namespace {

struct HandState {
  int x = 0;
  int y = 0;
  unsigned int buttons = 0;
  std::array<char, 32> keys{};
  bool operator==(const HandState&) const = default;
};

HandState read_hand(Display* display) {
  HandState hand;
  Window root = 0;
  Window child = 0;
  int window_x = 0;
  int window_y = 0;
  XQueryPointer(display, DefaultRootWindow(display), &root, &child, &hand.x, &hand.y, &window_x, &window_y,
                &hand.buttons);
  XQueryKeymap(display, hand.keys.data());
  return hand;
}

}  // namespace

struct InputWatch::Impl {
  Display* display = XOpenDisplay(nullptr);
  HandState at_start;
  ~Impl() {
    if (display != nullptr) XCloseDisplay(display);
  }
};

InputWatch::InputWatch() : impl_(std::make_unique<Impl>()) {}
InputWatch::~InputWatch() = default;

void InputWatch::start() {
  if (impl_->display != nullptr) impl_->at_start = read_hand(impl_->display);
}

bool InputWatch::has_happened() {
  return impl_->display != nullptr && read_hand(impl_->display) != impl_->at_start;
}

}  // namespace trocar::scene

// Xlib's macros (Status, None, Bool) conflict with other headers: nothing else is included here.

namespace trocar::scene::detail {

bool has_opengl_display() noexcept {
  Display* display = XOpenDisplay(nullptr);
  if (display == nullptr) return false;
  int opcode = 0;
  int first_event = 0;
  int first_error = 0;
  const bool has_glx = XQueryExtension(display, "GLX", &opcode, &first_event, &first_error) != 0;
  XCloseDisplay(display);
  return has_glx;
}

}  // namespace trocar::scene::detail
