#pragma once

namespace trocar::scene {

/// Puts the X server's pointer at a place of the screen, as a hand does.
void move_pointer(int x, int y);

}  // namespace trocar::scene
