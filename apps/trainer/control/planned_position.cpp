#include "control/planned_position.h"

#include <QCoreApplication>
#include <algorithm>

#include "attempt/tools/tool_motion.h"
#include "tasks/fit_to_patient.h"

namespace trocar::trainer {
namespace {

// Slower than the limits of a hand in attempt/tools/tool_motion.h, so that the tool does not cut corners through the
// body.
constexpr double kMost_mm_per_s = 0.8 * attempt::kFreeHand.most_mm_per_s;
constexpr double kMostAhead_mm = 20.0;  // a window's latency at this speed, and a transducer that presses
constexpr double kMost_rad_per_s = 0.8 * attempt::kFreeHand.most_rad_per_s;

}  // namespace

PlannedPosition::PlannedPosition(std::shared_ptr<const cases::OpenCase> open)
    : open_(std::move(open)),
      bevel_P_(tasks::planned_bevel_P(open_->the_case.task, *open_->the_case.patient, open_->the_case.plan.line_P)) {}

void PlannedPosition::start(ActiveTool tool) {
  if (tool == ActiveTool::kNeedle) is_needle_moving_ = true;
  if (tool == ActiveTool::kTransducer) is_probe_moving_ = true;
}

void PlannedPosition::stop(ActiveTool tool) {
  if (tool == ActiveTool::kNeedle) is_needle_moving_ = false;
  if (tool == ActiveTool::kTransducer) is_probe_moving_ = false;
}

void PlannedPosition::advance(attempt::PointerNeedle& needle, attempt::PointerProbe& probe,
                              const attempt::AttemptView& view, double dt_s) {
  constexpr double kLongest_s = 0.1;  // of a frame: a late one does not make the tool jump
  const double step_s = std::clamp(dt_s, 0.0, kLongest_s);
  const double most_mm = kMost_mm_per_s * step_s, most_rad = kMost_rad_per_s * step_s;
  const auto is_near = [](const Pose& hand, const Pose& tool) { return (hand.p() - tool.p()).norm() < kMostAhead_mm; };
  if (is_needle_moving_ && is_near(needle.X_PN(), view.needle.X_PN)) {
    const bool is_aimed = needle.approach(open_->the_case.plan.line_P, most_mm, most_rad);
    const bool is_turned = !bevel_P_ || needle.turn_bevel(*bevel_P_, most_rad);
    is_needle_moving_ = !(is_aimed && is_turned);
  }
  if (is_probe_moving_ && is_near(probe.X_PT(), view.probe.X_PT))
    is_probe_moving_ = !probe.approach(open_->X_PT_start, most_mm, most_rad);
}

QString planned_position_help(const tasks::Task& task, const tasks::Phase& phase) {
  const auto tool = attempt::tool_of(phase);
  if (!tool) return {};
  if (*tool == ActiveTool::kNeedle && task.guidance == tasks::ImagingModality::kPalpation)
    return QCoreApplication::translate("PlannedPosition",
                                       "Key P: a finger feels for bone. Stuck? Keys A, H: needle to "
                                       "the planned position");
  return *tool == ActiveTool::kTransducer
             ? QCoreApplication::translate("PlannedPosition", "Stuck? Keys S, H: transducer to the planned position")
             : QCoreApplication::translate("PlannedPosition", "Stuck? Keys A, H: needle to the planned position");
}

}  // namespace trocar::trainer
