#pragma once

#include <vector>

#include "anatomy/patient.h"
#include "tasks/task.h"

namespace trocar::tasks {

/// Postures in which paths are sought, in this order: the one that is chosen (Task::posture) alone; else those of the
/// task, the patient's own first if it is one of them; the patient's own where the task names none.
std::vector<anatomy::Posture> postures_to_try(const Task& task, const anatomy::VirtualPatient& patient);

/// The posture of an attempt: the first of them.
anatomy::Posture posture_of(const Task& task, const anatomy::VirtualPatient& patient);

}  // namespace trocar::tasks
