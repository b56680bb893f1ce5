#include <algorithm>

#include "tasks/operator.h"

namespace trocar::tasks {
namespace {

/// Largest number that a phase of the task asks for; 0: none does.
double asked_number(const Task& task, ConditionKind kind) {
  double most = 0.0;
  for (const Phase& phase : task.phases)
    for (const Condition& condition : phase.done)
      if (condition.kind == kind) most = std::max(most, condition.number);
  return most;
}

}  // namespace

OperatorActions actions_for(const Task& task, const Needle& needle) {
  OperatorActions actions;
  actions.gives_anaesthetic = task.pain.needs_anaesthesia;
  if (task.confirmed_by != Substance::kNothing)
    actions.confirms = needle.stylet_diameter_mm > 0.0 ? ActionKind::kDrawStylet : ActionKind::kAspirate;
  actions.wire_mm = asked_number(task, ConditionKind::kWire);
  actions.cores = task.cores;
  actions.loads_inside = needle.is_coaxial;
  return actions;
}

}  // namespace trocar::tasks
