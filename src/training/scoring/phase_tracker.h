#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "geometry/pose.h"
#include "metrics/metric.h"
#include "motion/patient_motion.h"
#include "tasks/action.h"
#include "tasks/needle.h"
#include "tasks/plan.h"
#include "tasks/task.h"
#include "telemetry/tick_sample.h"

namespace trocar::scoring {

/// What a phase tracker needs of one moment. The transducer is in P.
struct PhaseMoment {
  telemetry::TickSample needle;
  motion::PatientMotion motion;  ///< Where the patient is.
  std::optional<Pose> X_PT;      ///< Transducer; empty: none.
  double contact_n = 0.0;        ///< Of transducer and skin.
  double contrast_ml = 0.0;      ///< Injected so far.
  std::size_t cores = 0;         ///< Taken so far: shots into the body that brought tissue.
};

/// State of a phase of the task, in the task's order.
struct PhaseState {
  bool is_open = false;            ///< The phases before it are done.
  std::optional<double> begun_s;   ///< Session time at which it opened.
  std::optional<double> done_s;    ///< Session time at which its conditions had held for long enough.
  std::vector<std::string> lacks;  ///< What is not so at the last moment, in words; only while it is open and not done.
};

/// Follows an attempt through the phases of its task. A phase that is done stays done until repeat(). Not thread-safe;
/// step() takes some microseconds, with path_clear_mm or throw_clear some tens.
class PhaseTracker {
 public:
  /// Everything is copied or outlives the tracker.
  PhaseTracker(const tasks::Task& task, const anatomy::VirtualPatient& patient, const tasks::Needle& needle,
               const tasks::PlannedPath& plan, const metrics::ImagePlane& plane);
  ~PhaseTracker();
  PhaseTracker(PhaseTracker&&) noexcept;
  PhaseTracker& operator=(PhaseTracker&&) noexcept;

  /// An action of the trainee, in the order of time.
  void note(const tasks::Action& action);
  /// Moments in the order of time; values that are not finite are skipped.
  void step(const PhaseMoment& moment);
  std::span<const PhaseState> states() const noexcept;
  /// The first phase that is open and not done, in the task's order; empty: all are done, or the task has none.
  std::optional<std::size_t> current() const noexcept;
  /// Opens a phase again, with those that come after it: to practise it once more. It has to be done anew: actions and
  /// cores of before do not count, and conditions that hold at this moment count once they did not hold.
  void repeat(std::size_t phase);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::scoring
