#pragma once

#include <optional>
#include <string>

#include "anatomy/patient.h"
#include "tasks/action.h"
#include "tasks/task.h"
#include "telemetry/tick_sample.h"

namespace trocar::scoring {

/// Something that hurt the patient.
struct PainEvent {
  double time_s = 0.0;
  double depth_mm = 0.0;
  std::string label;  ///< The structure; empty: the skin without local anaesthetic.
};

/// Finds what hurts (tasks::PainRules) while an attempt runs: the skin pierced without anaesthetic, once, and each new
/// contact of the tip with a tissue that hurts. Task and patient outlive it.
class PainWatch {
 public:
  PainWatch(const tasks::Task& task, const anatomy::VirtualPatient& patient) noexcept
      : task_(&task), patient_(&patient) {}

  /// An action, in the order of time with the samples.
  void note(const tasks::Action& action) noexcept;
  /// The next sample; values that are not finite are skipped. Empty: nothing new hurts.
  std::optional<PainEvent> step(const telemetry::TickSample& sample);

 private:
  const tasks::Task* task_;
  const anatomy::VirtualPatient* patient_;
  bool is_anaesthetised_ = false, was_inside_ = false, has_pierced_skin_ = false;
  const anatomy::Label* touched_ = nullptr;
  double left_s_ = 0.0;  ///< Time of the last contact with `touched_`.
};

}  // namespace trocar::scoring
