#pragma once

namespace trocar::scene::detail {

/// True if $DISPLAY names an X server with OpenGL (GLX). Opens and closes a connection.
bool has_opengl_display() noexcept;

}  // namespace trocar::scene::detail
