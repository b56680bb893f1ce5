#include "scoring/detail/hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "anatomy/direction_words.h"
#include "anatomy/structure_words.h"

namespace trocar::scoring {
namespace {

constexpr double kMatters = 0.1;          // minimum lost share of a part's points for a hint
constexpr double kNameable = 0.5;         // rounds to 1 mm or degree
constexpr double kRepeatedTravel = 0.25;  // share of the excess travel for a hint about retractions

struct Hint {
  double lost_points;
  std::string text;
};

const ScorePart* find_part(std::span<const ScorePart> parts, std::string_view name) {
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const ScorePart& part) { return part.name == name; });
  return found != parts.end() ? &*found : nullptr;
}

/// Points lost in a part, 0 if negligible.
double lost(const HintSubject& subject, std::string_view name) {
  const ScorePart* part = find_part(subject.parts, name);
  const double points = part != nullptr ? part->max_points - part->points : 0.0;
  return part != nullptr && points >= kMatters * part->max_points ? points : 0.0;
}

std::string target_name(const HintSubject& subject) {
  return subject.is_parenchymal ? anatomy::structure_words(subject.task.organ) + " tissue" : "lesion";
}

/// "5 mm short of it and 4 mm too far towards the feet", with the advice.
struct Correction {
  std::string deviation;
  std::string advice;
};
Correction correct(const Vec3& offset_P, const Vec3& path_direction_P) {
  const double deeper_mm = offset_P.dot(path_direction_P);
  const Vec3 sideways_P = offset_P - deeper_mm * path_direction_P;
  const double least_mm =
      std::max(kNameable, anatomy::kSecondDirection * std::max(std::abs(deeper_mm), sideways_P.norm()));
  std::vector<std::string> deviations;
  std::vector<std::string> advice;
  if (std::abs(deeper_mm) >= least_mm) {
    deviations.push_back(
        fmt::format("{:.0f} mm {}", std::abs(deeper_mm), deeper_mm < 0.0 ? "short of the target" : "too deep"));
    advice.push_back(deeper_mm < 0.0 ? fmt::format("advance {:.0f} mm further", -deeper_mm)
                                     : fmt::format("stop {:.0f} mm earlier", deeper_mm));
  }
  if (sideways_P.norm() >= least_mm) {
    deviations.push_back(anatomy::direction_words(sideways_P, " mm too far"));
    advice.push_back("aim " + anatomy::direction_words(-sideways_P, " mm further"));
  }
  return {fmt::format("{}", fmt::join(deviations, ", ")), fmt::format("{}", fmt::join(advice, ", "))};
}

void add_target_hint(const HintSubject& subject, std::vector<Hint>& hints) {
  const Vec3 path_P = subject.plan.line_P.direction();
  const double lost_core = lost(subject, "core");
  const double lost_target = lost(subject, "target");
  if (subject.needle.is_biopsy && !subject.core) {
    const Correction correction = correct(subject.metrics.target_offset_P, path_P);
    const std::string where = lost_target > 0.0 ? fmt::format(" The tip stopped {}.", correction.deviation) : "";
    hints.push_back({lost_core + lost_target,
                     "No core was taken: bring the tip to the target, hold it still and fire the gun." + where});
  } else if (subject.core && subject.core->pieces.empty()) {  // deeper insertion would be wrong advice
    hints.push_back(
        {lost_core + lost_target,
         "No tissue was taken: the stylet hit bone. Choose an insertion point and a direction that pass beside "
         "it."});
  } else if (lost_core > 0.0) {
    const BiopsyCore& core = *subject.core;
    const double middle_mm = subject.needle.throw_mm - subject.needle.dead_space_mm - subject.needle.notch_mm / 2.0;
    const Vec3 notch_offset_P = core.tip_P + middle_mm * core.axis_P - (subject.plan.line_P.b + middle_mm * path_P);
    const Correction correction = correct(notch_offset_P, path_P);
    const std::string what = core.target_mm > 0.0
                                 ? fmt::format("The core holds only {:.0f} mm of {} of {:.0f} mm possible",
                                               core.target_mm, target_name(subject), subject.possible_core_mm)
                                 : fmt::format("The core missed the {}", target_name(subject));
    const std::string why = correction.deviation.empty() ? "."
                                                         : fmt::format(": the notch lay {}; {} before you fire.",
                                                                       correction.deviation, correction.advice);
    hints.push_back({lost_core + lost_target, what + why});
  } else if (lost_target > 0.0) {
    const Correction correction = correct(subject.metrics.target_offset_P, path_P);
    hints.push_back(
        {lost_target, fmt::format("The tip missed the target by {:.0f} mm, {}: {}.",
                                  subject.metrics.target_offset_P.norm(), correction.deviation, correction.advice)});
  }
}

void add_path_hints(const HintSubject& subject, std::vector<Hint>& hints) {
  const metrics::AttemptMetrics& metrics = subject.metrics;
  if (const double points = lost(subject, "entry"); points > 0.0)
    hints.push_back({points, fmt::format("The insertion point was {}: move the needle {} before you insert it.",
                                         anatomy::direction_words(metrics.entry_offset_P, " mm too far"),
                                         anatomy::direction_words(-metrics.entry_offset_P, " mm"))});
  if (const double points = lost(subject, "angle"); points > 0.0) {
    const Vec3 tilt_deg = metrics.angle_deg * (metrics.axis_P - subject.plan.line_P.direction()).normalized();
    hints.push_back({points, fmt::format("The needle pointed {}: tilt it so that its tip points {}.",
                                         anatomy::direction_words(tilt_deg, "° too far"),
                                         anatomy::direction_words(-tilt_deg, "° further"))});
  }
}

void add_risk_hints(const HintSubject& subject, std::vector<Hint>& hints) {
  for (const metrics::RiskTouch& touch : subject.metrics.risks)
    hints.push_back({touch.penalty, fmt::format("The needle touched a structure at risk, {}, {:.0f} mm below the skin: "
                                                "find it in the image and keep clear of it.",
                                                anatomy::structure_words(touch.label), touch.depth_mm)});
  for (const metrics::RiskTouch& touch : subject.stylet_risks)
    hints.push_back(
        {touch.penalty, fmt::format("The stylet shot into a structure at risk, {}: look {:.0f} mm beyond the "
                                    "tip before you fire.",
                                    anatomy::structure_words(touch.label), subject.needle.throw_mm)});
}

/// Travel beyond the path's length is either repeated after a retraction or beyond the target.
std::string travel_hint(const metrics::AttemptMetrics& metrics, double path_mm) {
  const double repeated_mm = metrics.travel_mm - metrics.deepest_mm;
  if (repeated_mm < kRepeatedTravel * (metrics.travel_mm - path_mm))
    return fmt::format(
        "The needle went {:.0f} mm deep for a path of {:.0f} mm: follow the tip in the image and stop at "
        "the target.",
        metrics.deepest_mm, path_mm);
  const std::string entries = metrics.entries > 1 ? fmt::format(" and pierced the skin {} times", metrics.entries) : "";
  return fmt::format(
      "The needle travelled {:.0f} mm inside the body{} for a path of {:.0f} mm, {:.0f} mm of it after "
      "pulling back: set its direction before you insert it and pull back less.",
      metrics.travel_mm, entries, path_mm, repeated_mm);
}

void add_economy_hints(const HintSubject& subject, std::vector<Hint>& hints) {
  const metrics::AttemptMetrics& metrics = subject.metrics;
  if (const double points = lost(subject, "length"); points > 0.0)
    hints.push_back({points, travel_hint(metrics, subject.plan.line_P.length_mm())});
  const bool is_finished = subject.core || !subject.needle.is_biopsy;
  if (const double points = lost(subject, "time"); points > 0.0 && is_finished)
    hints.push_back({points, fmt::format("It took {:.0f} s from the skin to the target: plan the path first, then go "
                                         "on without stopping.",
                                         metrics.time_s)});
  const auto dose = std::find_if(subject.parts.begin(), subject.parts.end(),
                                 [](const ScorePart& part) { return part.name == "dose"; });
  if (const double points = lost(subject, "dose"); points > 0.0 && dose != subject.parts.end())
    hints.push_back({points, fmt::format("The dose-area product was {:.1f} Gy cm²: press the pedal briefly, with few "
                                         "pulses a second, collimate, and work with the last image.",
                                         dose->value)});
}

std::string praise(const HintSubject& subject) {
  const std::string core =
      subject.core ? fmt::format(", {:.0f} mm of {} in the core", subject.core->target_mm, target_name(subject)) : "";
  return fmt::format("Well done: the tip came within {:.1f} mm of the target{}, and nothing at risk was touched.",
                     subject.metrics.target_offset_P.norm(), core);
}

}  // namespace

std::vector<std::string> make_hints(const HintSubject& subject) {
  if (!subject.metrics.has_touched_skin)
    return {"The needle never reached the skin: bring its tip to the planned insertion point."};
  if (!subject.metrics.has_entered)
    return {"The skin was not pierced: push steadily along the planned direction until it gives way."};

  std::vector<Hint> hints;
  add_risk_hints(subject, hints);
  add_target_hint(subject, hints);
  add_path_hints(subject, hints);
  add_economy_hints(subject, hints);
  std::stable_sort(hints.begin(), hints.end(),
                   [](const Hint& a, const Hint& b) { return a.lost_points > b.lost_points; });
  std::vector<std::string> texts;
  for (Hint& hint : hints) texts.push_back(std::move(hint.text));
  if (texts.empty()) texts.push_back(praise(subject));
  return texts;
}

}  // namespace trocar::scoring
