#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "metrics/attempt_metrics.h"
#include "scoring/score.h"

namespace trocar::scoring {

/// Data that hints use.
struct HintSubject {
  const tasks::Task& task;
  const tasks::Needle& needle;
  const tasks::PlannedPath& plan;
  const metrics::AttemptMetrics& metrics;
  const std::optional<BiopsyCore>& core;
  std::span<const metrics::RiskTouch> stylet_risks;  ///< Structures that only the stylet touched.
  double possible_core_mm;                           ///< Possible length of target tissue at the planned place.
  bool is_parenchymal;
  std::span<const ScorePart> parts;
};

/// Advice for improvement in the words of an instructor, the costliest first; praise if there is nothing to improve.
std::vector<std::string> make_hints(const HintSubject& subject);

}  // namespace trocar::scoring
