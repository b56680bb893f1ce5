#pragma once

#include "core/progress.h"
#include "tasks/needle.h"
#include "tasks/task.h"

namespace trocar::tasks {

/// Runs check_task and, if nothing is missing, the planner: a patient without a safe path cannot serve the task. The
/// planner's error is then the last of the reasons. `patient check` uses this function and therefore agrees with
/// `plan`.
TaskReadiness check_task_and_paths(const Task& task, const anatomy::VirtualPatient& patient, const Needle& needle,
                                   const Progress& progress = {});

}  // namespace trocar::tasks
