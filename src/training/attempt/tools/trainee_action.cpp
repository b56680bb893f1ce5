#include "attempt/tools/trainee_action.h"

#include <algorithm>

#include "attempt/guide/puncture_guide.h"

namespace trocar::attempt {
namespace {

bool asks_for(const tasks::Phase& phase, tasks::ConditionKind kind) {
  return std::ranges::find(phase.done, kind, &tasks::Condition::kind) != phase.done.end();
}

bool asks_for(const tasks::Task& task, tasks::ConditionKind kind) {
  return std::ranges::any_of(task.phases, [&](const tasks::Phase& phase) { return asks_for(phase, kind); });
}

}  // namespace

ActiveTool first_tool(const tasks::Task& task) {
  const bool is_transducer = task.phases.empty() ? task.guidance == tasks::ImagingModality::kUltrasound
                                                 : is_step_of_transducer(task.phases.front());
  return is_transducer ? ActiveTool::kTransducer : ActiveTool::kNeedle;
}

std::optional<ActiveTool> tool_of(const tasks::Phase& phase) {
  using Kind = tasks::ConditionKind;
  if (is_step_of_transducer(phase)) return ActiveTool::kTransducer;
  for (const Kind kind : {Kind::kTipOnSkin, Kind::kPathClear, Kind::kAimsAtTarget})
    if (asks_for(phase, kind)) return ActiveTool::kNeedle;
  return std::nullopt;
}

std::vector<TraineeAction> actions_of(const tasks::Task& task, const tasks::Needle& needle) {
  using Kind = tasks::ConditionKind;
  std::vector<TraineeAction> actions;
  if (task.pain.needs_anaesthesia || asks_for(task, Kind::kAnaesthetised))
    actions.push_back(TraineeAction::kAnaesthetic);
  if (!needle.is_biopsy && needle.stylet_diameter_mm > 0.0) actions.push_back(TraineeAction::kStylet);
  if (!needle.is_biopsy && needle.inner_diameter_mm > 0.0) actions.push_back(TraineeAction::kAspirate);
  if (asks_for(task, Kind::kWire)) actions.push_back(TraineeAction::kWire);
  if (asks_for(task, Kind::kBreathHeld) || task.breathing_mm > 0.0) actions.push_back(TraineeAction::kBreath);
  if (needle.is_biopsy) actions.push_back(TraineeAction::kLoad);
  return actions;
}

tasks::ActionRequest request_of(TraineeAction action, const ActionState& state) noexcept {
  switch (action) {
    case TraineeAction::kAnaesthetic:
      return {tasks::ActionKind::kAnaesthetise, kAnaesthetic_ml};
    case TraineeAction::kStylet:
      return {state.is_stylet_drawn ? tasks::ActionKind::kReplaceStylet : tasks::ActionKind::kDrawStylet};
    case TraineeAction::kAspirate:
      return {tasks::ActionKind::kAspirate};
    case TraineeAction::kWire:
      return {tasks::ActionKind::kAdvanceWire, state.wire_mm + kWireStep_mm};
    case TraineeAction::kBreath:
      return {state.is_breath_held ? tasks::ActionKind::kBreathe : tasks::ActionKind::kHoldBreath};
    case TraineeAction::kLoad:
      break;
  }
  return {tasks::ActionKind::kLoad};
}

Obstacle why_not(TraineeAction action, const ActionState& state, const tasks::Needle& needle) noexcept {
  if (!state.can_act) return Obstacle::kNotRunning;
  const bool needs_bore = action == TraineeAction::kAspirate || action == TraineeAction::kWire;
  if (needs_bore && needle.stylet_diameter_mm > 0.0 && !state.is_stylet_drawn) return Obstacle::kStyletInside;
  if (action != TraineeAction::kLoad) return Obstacle::kNone;
  if (state.is_gun_loaded) return Obstacle::kGunLoaded;
  return !needle.is_coaxial && !state.is_outside ? Obstacle::kNeedleInside : Obstacle::kNone;
}

}  // namespace trocar::attempt
