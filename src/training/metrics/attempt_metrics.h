#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "tasks/action.h"
#include "tasks/plan.h"
#include "tasks/task.h"
#include "telemetry/tick_sample.h"

namespace trocar::metrics {

/// Measures of an attempt, computed from its samples alone. Offsets are "is minus planned", in P.
struct AttemptMetrics {
  bool has_touched_skin = false;
  bool has_entered = false;  ///< The skin was pierced; if false, all values below stay zero.
  int entries = 0;           ///< Punctures of the skin.
  /// Offset of the needle's crossing of the skin, at the last entry before the end.
  Vec3 entry_offset_P = Vec3::Zero();
  Vec3 axis_P = Vec3::UnitZ();        ///< Axis of the needle at its end.
  double angle_deg = 0.0;             ///< Angle to the planned path.
  Vec3 tip_P = Vec3::Zero();          ///< Tip at the needle's end.
  Vec3 pierced_tip_P = Vec3::Zero();  ///< The same as far as layers have given way.
  Vec3 target_offset_P = Vec3::Zero();
  double travel_mm = 0.0;   ///< Inward path length of the tip inside the body, including repeated pushes after a pull
                            ///< back; motion to and fro of less than 1 mm is tremor and not counted.
  double deepest_mm = 0.0;  ///< Depth of the tip below the skin, the largest up to the end.
  double entry_s = 0.0;     ///< Time of the last entry before the end.
  double end_s = 0.0;       ///< Time of the end.
  double time_s = 0.0;      ///< From the first contact with the skin to the end, without interruptions.
};

/// Measures an attempt. `given_end`: sample of the end (scoring/attempt_end.h); empty: the deepest one. Samples without
/// an end (a killed session), none at all, or with values that are not finite are measured as far as possible.
AttemptMetrics measure_attempt(const anatomy::VirtualPatient& patient, const anatomy::TissueTable& tissues,
                               const tasks::PlannedPath& plan, std::span<const telemetry::TickSample> samples,
                               std::optional<std::size_t> given_end,
                               std::span<const tasks::Interruption> interruptions = {});

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
