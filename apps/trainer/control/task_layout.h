#pragma once

#include "tasks/task.h"

namespace trocar::trainer {

class Workspace;

/// A task that limits the dose is done, and seen again, under fluoroscopy: instead of the layout "Puncture" it gets
/// "X-ray"; another task the other way round. A layout that the user selected stays.
void choose_layout(const tasks::Task& task, Workspace& workspace);

}  // namespace trocar::trainer
