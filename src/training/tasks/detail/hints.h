#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tasks/metrics.h"
#include "tasks/score.h"

namespace trocar::tasks {

/// Data that hints use.
struct HintSubject {
  const Task& task;
  const Needle& needle;
  const PlannedPath& plan;
  const AttemptMetrics& metrics;
  const std::optional<BiopsyCore>& core;
  std::span<const RiskTouch> stylet_risks;  ///< Structures that only the stylet touched.
  double possible_core_mm;                  ///< Possible length of target tissue at the planned place.
  bool is_parenchymal;
  std::span<const ScorePart> parts;
};

/// Advice for improvement in the words of an instructor, the costliest first; praise if there is nothing to improve.
std::vector<std::string> make_hints(const HintSubject& subject);

}  // namespace trocar::tasks
