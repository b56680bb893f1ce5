#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "tasks/active_time.h"
#include "tasks/plan.h"
#include "tasks/task.h"
#include "telemetry/tick_sample.h"

namespace trocar::tasks {

/// A risk structure that the needle touched.
struct RiskTouch {
  std::string label;
  double depth_mm = 0.0;  ///< Of the tip below the skin, at the first touch.
  double penalty = 0.0;   ///< Points lost.
};

/// What an attempt did, measured from its samples alone. Offsets are "is minus planned", in P.
struct AttemptMetrics {
  bool has_touched_skin = false;
  bool has_entered = false;            ///< The skin was pierced; without it all below stays zero.
  int entries = 0;                     ///< Punctures of the skin.
  Vec3 entry_offset_P = Vec3::Zero();  ///< Where the needle crosses the skin, the last entry before the end.
  Vec3 axis_P = Vec3::UnitZ();         ///< Of the needle at its end.
  double angle_deg = 0.0;              ///< Against the planned path.
  Vec3 tip_P = Vec3::Zero();           ///< At its end: when fired, else where it was deepest.
  Vec3 target_offset_P = Vec3::Zero();
  double travel_mm = 0.0;        ///< Way of the tip inward inside the body, pulled back and pushed again
                                 ///< included; to and fro of less than 1 mm is tremor and not counted.
  double deepest_mm = 0.0;       ///< Depth of the tip below the skin, the largest up to the end.
  double time_s = 0.0;           ///< From the first contact with the skin to the end, without interruptions.
  std::vector<RiskTouch> risks;  ///< By tip and shaft, the whole attempt, one entry a label.
};

/// Measures an attempt. `fired`: sample at which the gun was fired. Samples without an end (a killed session), none at
/// all, or with values that are not finite are measured as far as they go.
AttemptMetrics measure_attempt(const Task& task, const anatomy::VirtualPatient& patient,
                               const anatomy::TissueTable& tissues, const PlannedPath& plan,
                               std::span<const telemetry::TickSample> samples, std::optional<std::size_t> fired,
                               std::span<const Interruption> interruptions = {});

}  // namespace trocar::tasks
