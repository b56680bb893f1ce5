#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "training/metrics.h"
#include "training/score.h"

namespace trocar {

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

/// A deviation in words of the patient: "6 mm towards the head and 4 mm to the patient's left"; the two largest
/// directions, the second where it is at least 0.4 of the first.
std::string direction_words(const Vec3& offset_P, const char* unit);

}  // namespace trocar
