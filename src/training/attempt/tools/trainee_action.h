#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tasks/action.h"
#include "tasks/needle.h"
#include "tasks/task.h"

namespace trocar::attempt {

/// What the trainee's hand moves; kNone: the mouse rotates the view.
enum class ActiveTool : std::uint8_t { kNone, kNeedle, kTransducer, kFinger };

/// The tool with which an attempt at the task begins.
ActiveTool first_tool(const tasks::Task& task);
/// The tool that a step of the task moves; empty: none, or it is in the body.
std::optional<ActiveTool> tool_of(const tasks::Phase& phase);

/// Actions besides moving a tool. A second one of kStylet and kBreath undoes the first.
enum class TraineeAction : std::uint8_t { kAnaesthetic, kStylet, kAspirate, kWire, kBreath, kLoad };

inline constexpr double kAnaesthetic_ml = 5.0;  ///< Of one action. Range 0..20. [assumed: a syringe of 5 ml]
inline constexpr double kWireStep_mm = 50.0;    ///< Of one action. Range 1..300. [assumed]

/// Actions that make sense in a task with this needle, in the order of TraineeAction.
std::vector<TraineeAction> actions_of(const tasks::Task& task, const tasks::Needle& needle);

/// State on which the actions depend.
struct ActionState {
  bool is_stylet_drawn = false, is_breath_held = false;
  double wire_mm = 0.0;  ///< Of the guide wire beyond the tip; 0: not in the needle.
  bool can_act = false;  ///< The attempt runs.
  bool is_gun_loaded = true, is_outside = true;
};
/// The request of an action.
tasks::ActionRequest request_of(TraineeAction action, const ActionState& state) noexcept;

/// Why an action is not possible.
enum class Obstacle : std::uint8_t {
  kNone,
  kNotRunning,    ///< The attempt does not run.
  kStyletInside,  ///< The stylet fills the needle's bore.
  kGunLoaded,
  kNeedleInside,  ///< Without a coaxial needle the gun is loaded outside of the body.
};
Obstacle why_not(TraineeAction action, const ActionState& state, const tasks::Needle& needle) noexcept;

}  // namespace trocar::attempt
