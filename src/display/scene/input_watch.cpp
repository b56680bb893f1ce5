#include "scene/input_watch.h"

#include <algorithm>
#include <array>

// Xlib's macros (Status, None, Bool) conflict with other headers: it comes last.
#include <X11/Xlib.h>

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
