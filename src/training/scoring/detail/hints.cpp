#include "scoring/detail/hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "anatomy/direction_words.h"
#include "anatomy/structure_words.h"
#include "core/ascii.h"

namespace trocar::scoring {
namespace {

constexpr double kMatters = 0.1;          // minimum lost share of a part's points for a hint
constexpr double kNameable = 0.5;         // rounds to 1 mm or degree
constexpr double kFullCore = 0.8;         // of the possible length: nothing to improve in this core
constexpr double kFails = 100.0;          // points of advice about a fault that fails the attempt
constexpr double kRepeatedTravel = 0.25;  // share of the excess travel for a hint about retractions

/// Advice, and the points that following it would bring.
struct Advice {
  double lost_points;
  std::string text;
  std::optional<double> at_s;
};

/// What advice is made of.
struct HintSubject {
  const Judgement& judged;
  const tasks::Task& task;
  const tasks::Needle& needle;
  const metrics::AttemptMetrics& measured;
  std::span<const ScorePart> parts;
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
  if (subject.task.target_tissues.empty() || subject.judged.is_parenchymal)
    return anatomy::structure_words(subject.task.organ) + " tissue";
  if (subject.task.target_tissues.front() == "csf") return "dural sac";
  return subject.needle.is_biopsy ? "lesion" : anatomy::structure_words(subject.task.target_tissues.front());
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

void add_core_hint(const HintSubject& subject, const BiopsyCore& core, double points, std::vector<Advice>& advice) {
  const Judgement& judged = subject.judged;
  if (core.pieces.empty()) {  // deeper insertion would be wrong advice
    advice.push_back({points,
                      "No tissue was taken: the stylet hit bone. Choose an insertion point and a direction that pass "
                      "beside it.",
                      core.time_s});
    return;
  }
  const double middle_mm = subject.needle.notch_middle_mm();
  const Vec3 path_P = judged.expert.line_P.direction();
  const Vec3 notch_offset_P = core.tip_P + middle_mm * core.axis_P - (judged.expert.line_P.b + middle_mm * path_P);
  const Correction correction = correct(notch_offset_P, path_P);
  const std::string what = core.target_mm > 0.0
                               ? fmt::format("The core holds only {:.0f} mm of {} of {:.0f} mm possible",
                                             core.target_mm, target_name(subject), judged.possible_core_mm)
                               : fmt::format("The core missed the {}", target_name(subject));
  const std::string why = correction.deviation.empty() ? "."
                                                       : fmt::format(": the notch lay {}; {} before you fire.",
                                                                     correction.deviation, correction.advice);
  advice.push_back({points, what + why, core.time_s});
}

/// Cores that were not taken.
void add_missing_cores(const HintSubject& subject, double points, std::vector<Advice>& advice) {
  const std::size_t taken = subject.judged.cores.size(), wanted = subject.task.cores;
  const char* const how = subject.needle.is_coaxial ? "load the gun again while the coaxial needle stays in place"
                                                    : "withdraw the needle, load the gun and puncture again";
  advice.push_back(
      {points,
       fmt::format("{} of {} cores {} taken: {}, and fire once more.", taken, wanted, taken == 1 ? "was" : "were", how),
       subject.judged.cores.back().time_s});
}

void add_target_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const Judgement& judged = subject.judged;
  const double lost_core = lost(subject, "core"), lost_target = lost(subject, "target");
  const Vec3 path_P = judged.expert.line_P.direction();
  const auto worst = std::min_element(judged.cores.begin(), judged.cores.end(),
                                      [](const auto& a, const auto& b) { return a.target_mm < b.target_mm; });
  const bool is_full = worst != judged.cores.end() && worst->target_mm >= kFullCore * judged.possible_core_mm;
  if (subject.needle.is_biopsy && judged.cores.empty()) {
    const Correction correction = correct(subject.measured.target_offset_P, path_P);
    const std::string where = lost_target > 0.0 ? fmt::format(" The tip stopped {}.", correction.deviation) : "";
    advice.push_back({lost_core + lost_target,
                      "No core was taken: bring the tip to the target, hold it still and fire the gun." + where,
                      subject.measured.end_s});
  } else if (lost_core > 0.0 && is_full && judged.cores.size() < subject.task.cores) {
    add_missing_cores(subject, lost_core, advice);
  } else if (worst != judged.cores.end() && (lost_core > 0.0 || worst->pieces.empty())) {
    add_core_hint(subject, *worst, lost_core + lost_target, advice);
  } else if (lost_target > 0.0) {
    const Correction correction = correct(subject.measured.target_offset_P, path_P);
    advice.push_back({lost_target,
                      fmt::format("The tip missed the {} by {:.0f} mm, {}: {}.", target_name(subject), judged.target_mm,
                                  correction.deviation, correction.advice),
                      subject.measured.end_s});
  }
}

void add_confirmation_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const double points = lost(subject, "confirmation");
  if (points <= 0.0) return;
  const char* const wanted = tasks::substance_words(subject.task.confirmed_by);
  const bool has_stylet = subject.needle.stylet_diameter_mm > 0.0;
  const auto looked = std::find_if(
      subject.judged.attempt.actions.begin(), subject.judged.attempt.actions.end(), [](const tasks::Action& action) {
        return action.kind == tasks::ActionKind::kDrawStylet || action.kind == tasks::ActionKind::kAspirate;
      });
  if (subject.judged.confirmed_s) {
    advice.push_back(
        {points,
         fmt::format("The {} came slowly: only a part of the bevel was in it. Turn the needle or advance it "
                     "by a millimetre or two.",
                     wanted),
         subject.judged.confirmed_s});
  } else if (looked == subject.judged.attempt.actions.end()) {
    advice.push_back({points,
                      fmt::format("Nothing proved the place: {} at the target and look whether {} comes.",
                                  has_stylet ? "draw the stylet" : "aspirate", wanted),
                      subject.measured.end_s});
  } else {
    advice.push_back(
        {points,
         fmt::format("{} came back: the needle was in the wrong place. Put the stylet back, correct the "
                     "tip and look again.",
                     looked->result.substance == tasks::Substance::kNothing
                         ? fmt::format("No {}", wanted)
                         : fmt::format("Not {} but {}", wanted, tasks::substance_words(looked->result.substance))),
         looked->time_s});
  }
}

void add_path_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const metrics::AttemptMetrics& measured = subject.measured;
  if (const double points = lost(subject, "entry"); points > 0.0)
    advice.push_back({points,
                      fmt::format("The insertion point was {}: move the needle {} before you insert it.",
                                  anatomy::direction_words(measured.entry_offset_P, " mm too far"),
                                  anatomy::direction_words(-measured.entry_offset_P, " mm")),
                      measured.entry_s});
  if (const double points = lost(subject, "angle"); points > 0.0) {
    const Vec3 tilt_deg =
        measured.angle_deg * (measured.axis_P - subject.judged.expert.line_P.direction()).normalized();
    advice.push_back(
        {points,
         fmt::format("The needle pointed {}: tilt it so that its tip points {}.",
                     anatomy::direction_words(tilt_deg, "° too far"), anatomy::direction_words(-tilt_deg, "° further")),
         measured.entry_s});
  }
}

/// Advice about the way: the worst fault of it.
void add_access_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const double points = lost(subject, "access");
  if (points <= 0.0) return;
  const AccessJudgement& access = subject.judged.access;
  std::string text;
  if (access.missing_margin_mm > kNameable)
    text = fmt::format(
        "The way passed the {} at {:.0f} mm; it needs {:.0f} mm. Choose another entry or angle before you "
        "insert the needle.",
        anatomy::structure_words(access.margin_label), std::max(0.0, access.margin_mm - access.missing_margin_mm),
        access.margin_mm);
  else if (access.outside_zone_mm > kNameable)
    text = fmt::format("The insertion point lay {:.0f} mm outside of the entry zone: move the needle {}.",
                       access.outside_zone_mm, anatomy::direction_words(access.to_zone_P, " mm"));
  else if (access.missing_away_mm > kNameable)
    text = fmt::format(
        "The tip ended {:.0f} mm from the {}, where large vessels run beside the target: choose a place that is {:.0f} "
        "mm "
        "away or more.",
        subject.task.target_away_mm - access.missing_away_mm, subject.task.target_away_from,
        subject.task.target_away_mm);
  else if (access.excess_angle_deg > kNameable)
    text = fmt::format("The needle met the skin too flat, by {:.0f}°: hold it steeper.", access.excess_angle_deg);
  else
    text = fmt::format(
        "The needle passed too little {}, by {:.0f} mm: choose a longer way through it, so that the "
        "channel closes.",
        anatomy::structure_words(subject.task.organ), access.missing_organ_mm);
  advice.push_back({points, std::move(text), subject.measured.entry_s});
}

void add_risk_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  for (const metrics::RiskTouch& touch : subject.measured.risks)
    advice.push_back({touch.penalty,
                      fmt::format("The needle touched a structure at risk, {}, {:.0f} mm below the skin: "
                                  "find it in the image and keep clear of it.",
                                  anatomy::structure_words(touch.label), touch.depth_mm),
                      touch.time_s});
  for (const metrics::RiskTouch& touch : subject.judged.stylet_risks)
    advice.push_back({touch.penalty,
                      fmt::format("The stylet shot into a structure at risk, {}: look {:.0f} mm beyond the "
                                  "tip before you fire.",
                                  anatomy::structure_words(touch.label), subject.needle.throw_mm),
                      subject.measured.end_s});
}

/// A fault that fails the attempt comes first.
void add_level_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  if (!subject.judged.too_high_s) return;
  std::string reason = subject.task.highest_entry->reason;
  if (!reason.empty()) reason.front() = ascii::to_upper(reason.front());
  advice.push_back(
      {kFails, reason + ": count the levels by the landmarks and enter lower.", subject.judged.too_high_s});
}

void add_bevel_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const double points = lost(subject, "bevel");
  if (points <= 0.0 || !subject.judged.bevel) return;
  advice.push_back(
      {points,
       fmt::format("The bevel stood {:.0f}° across the fibres of the {} and cut them: turn the needle about "
                   "its axis before you insert it, so that the bevel faces the patient's side.",
                   subject.judged.bevel->to_fibres_deg, anatomy::structure_words(subject.task.bevel->layer)),
       subject.judged.bevel->time_s});
}

void add_comfort_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const double points = lost(subject, "comfort");
  const std::vector<PainEvent>& pain = subject.judged.pain;
  if (points <= 0.0 || pain.empty()) return;
  const PainEvent& first = pain.front();
  advice.push_back({points,
                    first.label.empty()
                        ? std::string("The skin was pierced without local anaesthetic: give it first, "
                                      "and wait until it acts.")
                        : fmt::format("The tip met the {} at {:.0f} mm, which hurts: pull back a little "
                                      "and correct the direction, do not push on.",
                                      anatomy::structure_words(first.label), first.depth_mm),
                    first.time_s});
}

/// Travel beyond the path's length is either repeated after a retraction or beyond the target. Empty: the advice about
/// the target says it already.
std::string travel_hint(const HintSubject& subject, bool is_depth_told) {
  const metrics::AttemptMetrics& measured = subject.measured;
  const double path_mm = subject.judged.expert.line_P.length_mm();
  const double repeated_mm = measured.travel_mm - measured.deepest_mm;
  if (repeated_mm < kRepeatedTravel * (measured.travel_mm - path_mm)) {
    if (is_depth_told) return {};
    return fmt::format(
        "The needle went {:.0f} mm deep for a path of {:.0f} mm: follow the tip in the image and stop at "
        "the target.",
        measured.deepest_mm, path_mm);
  }
  const std::string entries =
      measured.entries > 1 ? fmt::format(" and pierced the skin {} times", measured.entries) : "";
  return fmt::format(
      "The needle travelled {:.0f} mm inside the body{} for a path of {:.0f} mm, {:.0f} mm of it after "
      "pulling back: set its direction before you insert it, so that it need not be corrected inside.",
      measured.travel_mm, entries, path_mm, repeated_mm);
}

void add_economy_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const bool is_depth_told = lost(subject, "target") > 0.0 || lost(subject, "core") > 0.0;
  if (const double points = lost(subject, "length"); points > 0.0)
    if (std::string text = travel_hint(subject, is_depth_told); !text.empty())
      advice.push_back({points, std::move(text), {}});
  const bool is_finished = !subject.judged.cores.empty() || !subject.needle.is_biopsy;
  if (const double points = lost(subject, "time"); points > 0.0 && is_finished)
    advice.push_back({points,
                      fmt::format("It took {:.0f} s from the skin to the target: plan the path first, then go "
                                  "on without stopping.",
                                  subject.measured.time_s),
                      {}});
  if (const double points = lost(subject, "dose"); points > 0.0)
    advice.push_back({points,
                      fmt::format("The dose-area product was {:.1f} Gy cm²: press the pedal briefly, with few "
                                  "pulses a second, collimate, and work with the last image.",
                                  find_part(subject.parts, "dose")->value),
                      {}});
  if (const double points = lost(subject, "passes"); points > 0.0)
    advice.push_back({points,
                      fmt::format("The {} was punctured {} times: stay in it, and correct the direction without "
                                  "leaving it.",
                                  anatomy::structure_words(subject.task.organ), subject.judged.bleeding->passes),
                      {}});
  if (const double points = lost(subject, "visibility"); points > 0.0)
    advice.push_back({points,
                      fmt::format("The tip was in the image during {:.0f} % of the advance: stop when you lose it, and "
                                  "move the transducer until you see it again.",
                                  find_part(subject.parts, "visibility")->value),
                      {}});
}

std::string praise(const HintSubject& subject) {
  const std::vector<BiopsyCore>& cores = subject.judged.cores;
  double target_mm = 0.0;
  for (const BiopsyCore& core : cores) target_mm += core.target_mm;
  const std::string taken = cores.empty() ? ""
                                          : fmt::format(", {:.0f} mm of {} in {}", target_mm, target_name(subject),
                                                        cores.size() == 1 ? "the core" : "the cores");
  const std::string where = subject.judged.target_mm < kNameable
                                ? fmt::format("the tip was in the {}", target_name(subject))
                                : fmt::format("the tip came within {:.1f} mm of the target", subject.judged.target_mm);
  return fmt::format(
      "Well done: {}{}, and nothing at risk was touched.",
      !cores.empty() ? fmt::format("the tip came within {:.1f} mm of the target", subject.judged.target_mm) : where,
      taken);
}

}  // namespace

std::vector<Hint> make_hints(const Judgement& judged, std::span<const ScorePart> parts) {
  if (!judged.measured.has_touched_skin)
    return {{"The needle never reached the skin: bring its tip to the planned insertion point.", {}}};
  if (!judged.measured.has_entered)
    return {{"The skin was not pierced: push steadily along the planned direction until it gives way.", {}}};

  const HintSubject subject{judged, judged.attempt.task, judged.attempt.needle, judged.measured, parts};
  std::vector<Advice> advice;
  add_level_advice(subject, advice);
  add_risk_advice(subject, advice);
  add_target_advice(subject, advice);
  add_confirmation_advice(subject, advice);
  add_access_advice(subject, advice);
  add_path_advice(subject, advice);
  add_bevel_advice(subject, advice);
  add_comfort_advice(subject, advice);
  add_economy_advice(subject, advice);
  std::stable_sort(advice.begin(), advice.end(),
                   [](const Advice& a, const Advice& b) { return a.lost_points > b.lost_points; });
  std::vector<Hint> hints;
  for (Advice& one : advice) hints.push_back({std::move(one.text), one.at_s});
  if (hints.empty()) hints.push_back({praise(subject), {}});
  return hints;
}

}  // namespace trocar::scoring
