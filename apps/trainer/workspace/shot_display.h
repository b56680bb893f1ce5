#pragma once

#include "attempt/guide/needle_view.h"
#include "tasks/needle.h"
#include "views/tools_shown.h"

namespace trocar::trainer {

/// Moves the needle, whose tip is at `depth_mm`, forward to its position `since_s` after a shot, and marks the place of
/// the core.
void show_shot(ToolsShown& tools, const attempt::GunShot& shot, double since_s, double depth_mm);

/// Marks the way of the stylet beyond the tip and the place of its notch if a biopsy gun were fired now.
void show_throw(ToolsShown& tools, const tasks::Needle& needle);

}  // namespace trocar::trainer
