#pragma once

#include <optional>
#include <string>
#include <vector>

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

/// Why an injection of local anaesthetic numbs nothing: "no anaesthetic was injected", "… into the air"; empty: it
/// numbs the skin around the needle's tip.
std::string why_not_numb(const tasks::Action& injection, const anatomy::VirtualPatient& patient);

/// Finds what hurts (tasks::PainRules) while an attempt runs: each time the skin gives way farther than kNumb_mm from
/// every injection of anaesthetic, once for the whole attempt; and each new contact of the tip with a tissue that
/// hurts. Touching the skin does not hurt. Task and patient outlive it.
class PainWatch {
 public:
  static constexpr double kNumb_mm = 20.0;  ///< Around an injection [assumed].

  PainWatch(const tasks::Task& task, const anatomy::VirtualPatient& patient) noexcept
      : task_(&task), patient_(&patient) {}

  /// An action, in the order of time with the samples.
  void note(const tasks::Action& action);
  /// The next sample; values that are not finite are skipped. Empty: nothing new hurts.
  std::optional<PainEvent> step(const telemetry::TickSample& sample);

 private:
  const anatomy::Label* touched_now(const telemetry::TickSample& sample) const;

  const tasks::Task* task_;
  const anatomy::VirtualPatient* patient_;
  std::vector<Vec3> numb_A_;  ///< Places of injections.
  bool was_inside_ = false, has_hurt_skin_ = false;
  const anatomy::Label* touched_ = nullptr;
  double left_s_ = 0.0;  ///< Time of the last contact with `touched_`.
};

}  // namespace trocar::scoring
