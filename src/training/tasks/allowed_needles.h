#pragma once

#include <string>
#include <vector>

#include "tasks/needle.h"
#include "tasks/task.h"

namespace trocar::tasks {

/// Names of the needles with which a task may be done: its own, and `Task::needles` or, without them, all of the same
/// use.
std::vector<std::string> allowed_needles(const Task& task, const std::vector<Needle>& all);

}  // namespace trocar::tasks
