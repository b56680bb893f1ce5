#include "x_pointer.h"

// Xlib's macros (Status, Success) spoil other headers: nothing else is included here.
#include <X11/Xlib.h>

namespace trocar::scene {

void move_pointer(int x, int y) {
  Display* display = XOpenDisplay(nullptr);
  XWarpPointer(display, 0, DefaultRootWindow(display), 0, 0, 0, 0, x, y);
  XSync(display, 0);
  XCloseDisplay(display);
}

}  // namespace trocar::scene
