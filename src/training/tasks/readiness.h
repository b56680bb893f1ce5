#pragma once

#include "core/progress.h"
#include "tasks/needle.h"
#include "tasks/task.h"

namespace trocar::tasks {

/// check_task, and where that finds nothing missing the planner itself: a patient without a safe path cannot serve the
/// task. The planner's error is then the last of the reasons. For `patient check`, which agrees with `plan` this way.
TaskReadiness check_task_and_paths(const Task& task, const anatomy::VirtualPatient& patient, const Needle& needle,
                                   const Progress& progress = {});

}  // namespace trocar::tasks
