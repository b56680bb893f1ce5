#pragma once

namespace trocar::scene {

/// Moves the X server's pointer to a screen position.
void move_pointer(int x, int y);

}  // namespace trocar::scene
