#pragma once

#include <cstdint>
#include <optional>

#include "anatomy/patient.h"
#include "tasks/task.h"
#include "telemetry/tick_sample.h"

namespace trocar::metrics {

/// The bevel at the punctures of the layer whose fibres it has to part (tasks::BevelRule); of several the worst.
/// Frame P.
class WorstBevel {
 public:
  struct Puncture {
    double to_fibres_deg = 0.0;  ///< 0..90, see tasks::bevel_to_fibres_deg.
    double time_s = 0.0;
  };

  /// Task and patient outlive it. `layer`: id of the rule's layer in events; empty: events do not know it.
  WorstBevel(const tasks::Task& task, const anatomy::VirtualPatient& patient, std::optional<std::uint8_t> layer)
      : task_(&task), patient_(&patient), layer_(layer) {}

  /// `R_PN`: the needle with its roll, +y to the bevel's face.
  void step(double time_s, const Vec3& tip_P, const Mat3& R_PN, const telemetry::TickEvents& events);

  bool has_punctured() const noexcept { return has_punctured_; }  ///< The layer, with or without fibres there.
  /// Empty: the task has no such rule, the layer was not punctured, or the patient lacks the fibres.
  const std::optional<Puncture>& worst() const noexcept { return worst_; }

 private:
  const tasks::Task* task_;
  const anatomy::VirtualPatient* patient_;
  std::optional<std::uint8_t> layer_;
  bool has_punctured_ = false;
  std::optional<Puncture> worst_;
};

}  // namespace trocar::metrics
