#pragma once

#include <string>

#include "anatomy/patient.h"
#include "tasks/task.h"

namespace trocar::tasks::detail {

/// What the patient's target lacks for a task with least_target_ml, in one line; empty: nothing, or the task has none.
std::string target_shortage(const Task& task, const anatomy::VirtualPatient& patient);

}  // namespace trocar::tasks::detail
