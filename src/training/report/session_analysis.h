#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "storage/session_file.h"
#include "tasks/needle.h"
#include "tasks/plan.h"
#include "tasks/task.h"

namespace trocar::report {

/// A punctured layer.
struct Puncture {
  std::size_t tick = 0;
  std::string layer;
  double time_s = 0.0;
  double depth_mm = 0.0;
  double layer_force_n = 0.0;  ///< Force on the tip at the puncture.
  double resistance_n = 0.0;   ///< Sum of all axial forces at that tick.
  double drop_n = 0.0;         ///< Fall of the resistance within the next 0.1 s, before another puncture.
};
std::vector<Puncture> find_punctures(const storage::Session& session);

/// One insertion of the needle: the ticks from the first contact to the last tick before the needle is outside again.
struct Insertion {
  std::size_t first = 0;
  std::size_t deepest = 0;  ///< Tick of the greatest depth.
  std::size_t last = 0;
};
/// Insertions that reached at least `min_depth_mm`, in order.
std::vector<Insertion> find_insertions(const storage::Session& session, double min_depth_mm = 1.0);

/// An interval of one tissue along the path of the tip.
struct TissueRun {
  double from_mm = 0.0;
  double to_mm = 0.0;
  std::uint8_t tissue = 0;
};
/// Tissues that the tip passed during insertion, by depth: each depth counts when it is reached for the first time.
std::vector<TissueRun> tissues_along(const storage::Session& session, const Insertion& insertion);

/// An interval of one phase.
struct PhaseRun {
  double from_s = 0.0;
  double to_s = 0.0;
  telemetry::InsertionPhase phase = telemetry::InsertionPhase::kOutside;
};
std::vector<PhaseRun> phase_runs(const storage::Session& session);

/// Name of a tissue id; "#7" if the session has none.
std::string tissue_name(const storage::SessionInfo& info, std::uint8_t id);

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
