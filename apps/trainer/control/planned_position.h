#pragma once

#include <QString>
#include <memory>
#include <optional>

#include "attempt/live/attempt_view.h"
#include "attempt/tools/pointer_tools.h"
#include "cases/open_case.h"
#include "panels/puncture_panel.h"

namespace trocar::trainer {

/// Brings tools that mouse and keys lead to their planned poses, over the skin and at the speed of a hand, so that the
/// trainee sees the way. A gesture of a tool ends its motion: call stop().
class PlannedPosition {
 public:
  explicit PlannedPosition(std::shared_ptr<const cases::OpenCase> open);

  void start(ActiveTool tool);
  void stop(ActiveTool tool);
  /// Call once per frame. A hand waits for a tool that is far behind it (`view`): from there the tool would go straight
  /// to it, through the body.
  void advance(attempt::PointerNeedle& needle, attempt::PointerProbe& probe, const attempt::AttemptView& view,
               double dt_s);

 private:
  std::shared_ptr<const cases::OpenCase> open_;
  std::optional<Vec3> bevel_P_;  ///< Where the bevel has to face; empty: anywhere.
  bool is_needle_moving_ = false, is_probe_moving_ = false;
};

/// What a trainee who is stuck in a step of the task can do: the key to the planned position, and the finger where
/// landmarks are palpable. Empty for steps without one.
QString planned_position_help(const tasks::Task& task, const tasks::Phase& phase);

}  // namespace trocar::trainer
