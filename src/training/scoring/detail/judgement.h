#pragma once

#include <optional>
#include <string>
#include <vector>

#include "metrics/attempt_track.h"
#include "metrics/harm_watch.h"
#include "scoring/pain.h"
#include "scoring/score.h"

namespace trocar::scoring {

/// Time at which the tip came into the target above the level that the task permits (tasks::EntryLevel); empty: it did
/// not, or task or patient have no such level. The level is the height (z) of the structure's centroid.
std::optional<double> entered_too_high_s(const AttemptData& attempt);

/// The bevel at the worst puncture of the layer whose fibres it has to part; empty: see metrics::WorstBevel.
std::optional<metrics::WorstBevel::Puncture> judge_bevel(const AttemptData& attempt);

/// Distance that the tip lacks to what the target keeps from a landmark (Task::target_away_mm), mm; 0: none.
double missing_away_mm(const AttemptData& attempt, const Vec3& tip_P);

/// Way of the needle as it was, measured like a planned path.
struct AccessJudgement {
  double missing_margin_mm = 0.0;  ///< Largest part of a margin that is missing; the whole margin: crossed.
  std::string margin_label;        ///< The structure with the missing margin; empty: none.
  double margin_mm = 0.0;          ///< The margin that it needs.
  double excess_angle_deg = 0.0;   ///< Beyond the largest angle to the skin's normal.
  double outside_zone_mm = 0.0;    ///< Of the entry, outside the task's entry zone.
  Vec3 to_zone_P = Vec3::Zero();   ///< From the entry to the zone's edge.
  double missing_organ_mm = 0.0;   ///< Of the organ that has to be passed.
  double missing_away_mm = 0.0;    ///< Of the distance that the target keeps from a landmark.
};

/// Everything that parts and hints are made of.
struct Judgement {
  const AttemptData& attempt;
  const tasks::PlannedPath& expert;  ///< The nearest one.
  metrics::AttemptMetrics measured;  ///< Against this path.
  bool is_parenchymal = false;
  /// The target is a place, not a structure: a point of the task, or of the plan in healthy organ.
  bool is_planned_place = false;
  double target_mm = 0.0;  ///< Distance to the target, of the notch for a biopsy needle; 0 in a target structure.
  std::optional<Vec3> to_target_P = {};  ///< From there to the nearest point of the target structure, of the last core.
  double entry_mm = 0.0;                 ///< Of the entry, from the zone's edge or the expert's.
  AccessJudgement access = {};
  std::vector<BiopsyCore> cores = {};          ///< By time.
  double possible_core_mm = 0.0;               ///< Length of target tissue in a core at the planned place.
  std::vector<metrics::HarmEvent> harms = {};  ///< The gravest first; those without harm are left out.
  std::vector<PainEvent> pain = {};
  std::optional<double> confirmed_s = {};  ///< Time at which the right substance came back.
  std::optional<Bleeding> bleeding = {};
  std::optional<double> too_high_s = {};  ///< Time at which the target was entered above the permitted level.
  std::optional<metrics::WorstBevel::Puncture> bevel = {};
};

/// Judges an attempt against its nearest expert path.
Judgement judge(const AttemptData& attempt, std::size_t& expert);
/// True if the needle has done what it was put in for: a core was taken, or the target was reached.
bool is_finished(const Judgement& judged) noexcept;
/// Score, verdict and advice that follow from a judgement.
Outcome conclude(const Judgement& judged);

}  // namespace trocar::scoring
