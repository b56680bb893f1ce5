#pragma once

namespace trocar::scene::detail {

/// Whether $DISPLAY leads to an X server with OpenGL (GLX). Opens and closes a connection.
bool has_opengl_display() noexcept;

}  // namespace trocar::scene::detail
