#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "metrics/harm_watch.h"
#include "metrics/metric.h"
#include "tasks/action.h"
#include "tasks/needle.h"
#include "tasks/plan.h"
#include "tasks/task.h"
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
  std::vector<std::string> risks_in_throw;  ///< What the throw harms, or comes near to (a risk), by label name.
  double time_s = 0.0;                      ///< Session time of the shot; 0 in a session of an older program.
};

/// Likelihood that a puncture of an organ bleeds, by what the attempt shows; see docs/tasks.md. [assumed grades]
enum class BleedingRisk : std::uint8_t { kUsual, kRaised, kHigh };
const char* to_string(BleedingRisk risk) noexcept;
std::optional<BleedingRisk> find_bleeding_risk(std::string_view name) noexcept;

struct Bleeding {
  BleedingRisk risk = BleedingRisk::kUsual;
  std::vector<std::string> reasons;  ///< "the organ was punctured 4 times"; empty with kUsual.
  std::size_t passes = 0;            ///< Punctures of the organ's surface from outside.
};

/// Display text of one of tasks::kScoreParts: "Needle direction"; empty for another name.
std::string_view part_title(std::string_view part) noexcept;

struct ScorePart {
  std::string name;   ///< One of tasks::kScoreParts.
  std::string title;  ///< Display text.
  double value = 0.0;
  std::string unit;
  double points = 0.0;  ///< 0..max_points.
  double max_points = 0.0;
  bool is_judged = true;  ///< False: the attempt did not come so far, which gives no points; there is no value.
};
/// Parts by which an attempt is judged, in the order of display, with their points; they add up to 100. A part of the
/// task that this needle cannot show (no core without a biopsy needle) or no transducer sees (visibility) is left out.
std::vector<std::pair<std::string, double>> judged_parts(const tasks::Task& task, const tasks::Needle& needle,
                                                         bool has_transducer);
/// Text of a part's value: "3.1 mm", a number of events, or whether the place was proven.
std::string part_value_text(const ScorePart& part);
/// True for a part of a session of an older program that contains penalties beyond the points of the part "risk".
inline bool is_deduction(const ScorePart& part) noexcept {
  return part.max_points <= 0.0;
}

/// Advice, with the moment of the attempt to look at.
struct Hint {
  std::string text;
  std::optional<double> at_s;  ///< Session time; empty: the whole attempt.

  bool operator==(const Hint&) const = default;
};

/// Result of an attempt. A deviation d (target, entry, angle, access, comfort) with tolerance t is worth
/// max_points/(1 + (d/t)^2); an expense e (length, time, dose) with limit l is worth max_points*(1 - (e/l)^2), 0 from l
/// on; docs/physics.md, E1. Smaller is never worse. No part is negative; the parts' points add up to the score, within
/// 0..100. The parts are those of judged_parts. Several cores are worth their target tissue together against that of
/// the task's number of cores; the end of the attempt is the first shot after the skin gave way. The weights are the
/// task's. An attempt that never pierced the skin, and a biopsy without a shot in the body, have no end position and
/// are not scored. Harm decides before the sum: with a critical or a major one the attempt is not passed.
struct Outcome {
  /// Reason why it is not scored; then the score is 0 and there are no parts. Empty: it is scored.
  std::string not_scored;
  double score = 0.0;  ///< 0..100.
  /// A biopsy: the cores hold at least half of the target tissue that one core could hold (of healthy organ: and were
  /// taken within the tolerance of the planned place). Otherwise: what has to come back came, with the tip in the
  /// target and its wall pierced; where nothing has to, the tip was in it, or within the tolerance of the task's target
  /// point. Harm does not change it.
  bool target_reached = false;
  bool is_passed = false;  ///< `fails` is empty and it is scored.
  std::vector<std::string>
      fails;  ///< Reasons why it is not passed, harm first: "the needle went 12 mm into the heart".
  std::vector<ScorePart> parts;
  std::vector<Hint> hints;                     ///< Advice for improvement, most important first.
  std::vector<BiopsyCore> cores;               ///< By time.
  std::optional<Bleeding> bleeding;            ///< Empty: the target is a fluid, or an older program.
  std::vector<metrics::HarmEvent> harms;       ///< The gravest first; empty in a session of an older program.
  std::vector<std::string> risks_touched;      ///< Labels of the harms, by time.
  std::size_t expert = 0;                      ///< The expert path with which it is compared: the nearest one.
  std::size_t pain_events = 0;                 ///< See tasks::PainRules.
  std::vector<metrics::MetricValue> measures;  ///< Of the whole recording; empty in a session of an older program.

  bool is_scored() const noexcept { return not_scored.empty(); }
  /// The core with the most target tissue; null: none was taken.
  const BiopsyCore* best_core() const noexcept;
};

/// "reached", "not confirmed" (the needle was in it, and what has to come back did not), "not reached" (it stopped less
/// than 1 mm away) or "missed".
const char* target_words(const Outcome& outcome) noexcept;

/// Takes the core at a fired tick. The stylet goes straight on from the tip; bone stops it, and the part of the notch
/// that then stays inside the cannula takes nothing.
BiopsyCore take_core(const tasks::Task& task, const anatomy::VirtualPatient& patient, const tasks::Needle& needle,
                     const Vec3& tip_P, const Vec3& axis_P);

/// All data of an attempt that its score depends on. Everything outlives the call.
struct AttemptData {
  const tasks::Task& task;
  const anatomy::VirtualPatient& patient;
  const anatomy::TissueTable& tissues;
  const tasks::Needle& needle;
  std::span<const tasks::PlannedPath> experts;  ///< At least one; the nearest one is compared with.
  std::span<const telemetry::TickSample> samples;
  std::span<const std::size_t> shots = {};                  ///< Samples at which the biopsy gun was fired, in order.
  std::span<const tasks::Interruption> interruptions = {};  ///< Not counted.
  std::span<const tasks::Action> actions = {};
  tasks::XrayUse xray = {};  ///< At the end of the attempt.
  bool has_transducer = false;
  std::optional<double> tip_visible_share = {};  ///< Of the advance, 0..1; empty: there was none.
};
/// Scores a whole attempt.
Outcome score_attempt(const AttemptData& attempt);

}  // namespace trocar::scoring
