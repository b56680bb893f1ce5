#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tasks/metrics.h"
#include "tasks/score.h"

namespace trocar::tasks {

/// All that a hint may speak of.
struct HintSubject {
  const Task& task;
  const Needle& needle;
  const PlannedPath& plan;
  const AttemptMetrics& metrics;
  const std::optional<BiopsyCore>& core;
  std::span<const RiskTouch> stylet_risks;  ///< What only the stylet touched.
  double possible_core_mm;                  ///< Of the target tissue at the planned place.
  bool is_parenchymal;
  std::span<const ScorePart> parts;
};

/// What to do better, as an instructor would say it, the costliest first; praise where nothing matters.
std::vector<std::string> make_hints(const HintSubject& subject);

}  // namespace trocar::tasks
