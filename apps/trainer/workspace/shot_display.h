#pragma once

#include "attempt/guide/gun_shot.h"
#include "views/tools_shown.h"

namespace trocar::trainer {

/// Moves the needle, whose tip is felt at `depth_mm`, forward as so long after a shot, and marks where its core came
/// from.
void show_shot(ToolsShown& tools, const attempt::GunShot& shot, double since_s, double depth_mm);

}  // namespace trocar::trainer
