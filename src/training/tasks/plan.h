#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"
#include "tasks/needle.h"
#include "tasks/task.h"

namespace trocar::tasks {

/// A path that keeps every margin of its task, over the throw of a biopsy needle too.
struct PlannedPath {
  /// From the entry on the skin to the end position of the tip: at the target, or for a biopsy needle short of it, so
  /// that the centre of the notch is in the target after firing.
  Segment line_P{Vec3::Zero(), Vec3::Zero()};
  double length_mm = 0.0;
  double organ_path_mm = 0.0;  ///< Length inside the organ before the lesion or the tip, whichever comes first.
  /// Smallest clearance to a risk structure minus the margin that the task requires for it; at most 10. The clearance
  /// itself is this value plus the margin of nearest_risk.
  double spare_margin_mm = 0.0;
  anatomy::Posture posture = anatomy::Posture::kSupine;  ///< In which the entry is reached.
  std::string nearest_risk;                              ///< Label name; empty: none within 10 mm beyond its margin.
  double cost_mm = 0.0;                                  ///< See path_cost_mm; planned paths only.
};

/// Cost by which paths are ranked: the length plus a penalty for spare margin below 10 mm,
/// length + 20 mm (1 - spare / 10 mm)^2. The first millimetre of spare margin is worth 3.8 mm of length, the fifth
/// 2.2 mm, the tenth 0.2 mm. src/training/tasks/README.md.
double path_cost_mm(double length_mm, double spare_margin_mm) noexcept;

struct PlanOptions {
  int count = 1;  ///< Number of paths, with different entries or targets. Range 1..100000.
  std::uint64_t seed = 1;
};

/// Safe paths, lowest cost (path_cost_mm) first; each passes skin, muscle and organ surface, in this order and nothing
/// else with a surface. Several paths have entries as far apart as possible (16 mm and less); the result has fewer than
/// `count` if the patient has no more. The same seed gives the same paths for any number of threads. Paths are
/// sought in the task's postures (postures_to_try), and are those of the first one that has any. The error names for
/// each posture the constraint that left no path.
Result<std::vector<PlannedPath>> plan_paths(const Task& task, const anatomy::VirtualPatient& patient,
                                            const Needle& needle, const PlanOptions& options = {},
                                            const Progress& progress = {});

}  // namespace trocar::tasks
