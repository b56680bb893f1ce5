#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"
#include "training/needle.h"
#include "training/task.h"

namespace trocar {

/// A path that keeps every margin of its task.
struct PlannedPath {
  Segment line_P;  ///< Entry on the skin -> target of the tip.
  double length_mm = 0.0;
  double organ_path_mm = 0.0;       ///< Length inside the organ before the target.
  double smallest_margin_mm = 0.0;  ///< Clearance to the nearest risk structure, beyond the required margin.
  std::string nearest_risk;
};

struct PlanOptions {
  int count = 1;  ///< How many paths, different entries. Range 1..100000.
  std::uint64_t seed = 1;
};

/// Safe paths, best (shortest) first; each passes skin, muscle and organ surface. The error says which margin left no
/// path.
Result<std::vector<PlannedPath>> plan_paths(const Task& task, const VirtualPatient& patient, const Needle& needle,
                                            const PlanOptions& options = {}, const Progress& progress = {});

}  // namespace trocar
