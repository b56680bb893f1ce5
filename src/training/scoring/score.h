#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "tasks/active_time.h"
#include "tasks/needle.h"
#include "tasks/plan.h"
#include "tasks/task.h"
#include "tasks/xray_use.h"
#include "telemetry/tick_sample.h"

namespace trocar::scoring {

/// Tissue along one stretch of the specimen notch.
struct CorePiece {
  std::string label;     ///< Label name.
  std::string tissue;    ///< Tissue class.
  double from_mm = 0.0;  ///< From the open notch's proximal end.
  double to_mm = 0.0;
};

/// Core taken by the biopsy gun.
struct BiopsyCore {
  Vec3 tip_P = Vec3::Zero();  ///< Needle tip when fired.
  Vec3 axis_P = Vec3::UnitZ();
  std::vector<CorePiece> pieces;
  double target_mm = 0.0;  ///< Length of the target tissue (the lesion, or the organ in a parenchymal biopsy).
  double organ_mm = 0.0;   ///< Length of the organ around the target; the four lengths add up to the open notch.
  double vessel_mm = 0.0;
  double other_mm = 0.0;
  std::vector<std::string> risks_in_throw;  ///< Risk structures over the whole throw, by label name.
};

struct ScorePart {
  std::string name;   ///< "target", "entry", "angle", "risk", "length", "time", "core", "dose", "deduction".
  std::string title;  ///< Display text.
  double value = 0.0;
  std::string unit;
  double points = 0.0;      ///< 0..max_points; negative for a deduction.
  double max_points = 0.0;  ///< 0 for a deduction.
};
/// True for the part that contains penalties beyond the points of the part "risk". It exists only if there are such
/// penalties.
inline bool is_deduction(const ScorePart& part) noexcept {
  return part.max_points <= 0.0;
}

/// Result of an attempt. A deviation d (target, entry, angle) with tolerance t is worth max_points/(1 + (d/t)^2); an
/// expense e (length, time) with limit l is worth max_points*(1 - (e/l)^2), 0 from l on; docs/physics.md, S1. Smaller
/// is never worse. The parts' points add up to the score, within 0..100. An entry inside the task's entry zone is worth
/// all points; outside, its deviation counts from the zone's edge. An attempt that never pierced the skin, and a biopsy
/// without a shot, have no end position and are not scored. The points of each part are teaching policy [assumed].
struct Outcome {
  /// Reason why it is not scored; then the score is 0 and there are no parts. Empty: it is scored.
  std::string not_scored;
  double score = 0.0;  ///< 0..100.
  /// The tip ended within the target tolerance, for a biopsy with a core taken; or within twice the tolerance with a
  /// core that holds at least half of the lesion tissue that was possible. Touched risks do not change it.
  bool target_reached = false;
  std::vector<ScorePart> parts;
  std::vector<std::string> hints;  ///< Advice for improvement, most important first.
  std::optional<BiopsyCore> core;
  std::vector<std::string> risks_touched;

  bool is_scored() const noexcept { return not_scored.empty(); }
};

/// Takes the core at a fired tick. The stylet goes straight on from the tip; bone stops it, and the part of the notch
/// that then stays inside the cannula takes nothing.
BiopsyCore take_core(const tasks::Task& task, const anatomy::VirtualPatient& patient, const tasks::Needle& needle,
                     const Vec3& tip_P, const Vec3& axis_P);

/// Scores a whole attempt. `fired` is the index of the sample at which the biopsy gun was fired. Time in an
/// interruption is not counted. `xray`: use of X-ray at the end of the attempt.
Outcome score_attempt(const tasks::Task& task, const anatomy::VirtualPatient& patient,
                      const anatomy::TissueTable& tissues, const tasks::Needle& needle, const tasks::PlannedPath& plan,
                      std::span<const telemetry::TickSample> samples, std::optional<std::size_t> fired,
                      std::span<const tasks::Interruption> interruptions = {}, const tasks::XrayUse& xray = {});

}  // namespace trocar::scoring
