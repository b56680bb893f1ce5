#include "scene/detail/display.h"

// Xlib's macros (Status, None, Bool) conflict with other headers: nothing else is included here.
#include <X11/Xlib.h>

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
