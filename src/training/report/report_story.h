#pragma once

#include <optional>
#include <string>
#include <vector>

#include "storage/session_file.h"
#include "tasks/needle.h"
#include "tasks/plan.h"
#include "tasks/task.h"

namespace trocar::report {

/// A step of the task (tasks::Phase) in an attempt. Session times.
struct StepTime {
  std::string title;
  std::optional<double> begun_s;  ///< Empty: the steps before it were not done.
  std::optional<double> done_s;   ///< Empty: it was not done.
};

/// An action of the trainee in words.
struct ActionLine {
  double time_s = 0.0;    ///< Session time.
  double depth_mm = 0.0;  ///< Of the tip below the skin.
  std::string text;
};

/// What a report tells beside the session: it depends on case and tables.
struct ReportStory {
  std::vector<StepTime> steps;      ///< In the task's order; empty: the task has none, or the case is not at hand.
  std::vector<ActionLine> actions;  ///< By time.
  std::string title = {};           ///< Of the task; empty: the case is not at hand.
  bool needs_image = true;          ///< The needle is guided by ultrasound.
};

/// True for the hint of an attempt at which nothing is to be improved: "Well done: ...".
bool is_praise(const scoring::Hint& hint) noexcept;

/// The steps of a recorded attempt, each when it was done for the first time: that a trainee repeated a step is not
/// recorded. `task` is fitted to the patient.
std::vector<StepTime> step_times(const storage::Session& session, const tasks::Task& task,
                                 const anatomy::VirtualPatient& patient, const tasks::Needle& needle,
                                 const tasks::PlannedPath& plan);

}  // namespace trocar::report
