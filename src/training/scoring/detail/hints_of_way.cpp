// Advice about the needle's way: what it harmed, its entry and direction, pain, economy.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "anatomy/structure_words.h"
#include "scoring/detail/hints.h"

namespace trocar::scoring {
namespace {

constexpr double kOtherWay_deg = 60.0;    // from here on a tilt is no correction
constexpr double kNoRoom_mm = 0.5;        // a distance that would be written as 0
constexpr double kRepeatedTravel = 0.25;  // share of the excess travel for a hint about retractions

/// What keeps a needle clear of a structure, by what guides it.
const char* how_to_avoid(tasks::ImagingModality guidance) noexcept {
  switch (guidance) {
    case tasks::ImagingModality::kUltrasound:
      return "find it in the image before you insert the needle, and keep clear of it";
    case tasks::ImagingModality::kXray:
      return "choose an entry and a direction that pass beside it, and check them in the X-ray image";
    case tasks::ImagingModality::kPalpation:
      return "feel the landmarks again, and keep to the planned entry, direction and depth";
  }
  return "";
}

std::string harm_advice(const HintSubject& subject, const metrics::HarmEvent& event) {
  const anatomy::Label* const label = subject.judged.attempt.patient.label_table.find(event.label);
  const bool is_bone = label != nullptr && label->tissue == "bone";
  if (event.is_by_stylet || event.is_by_notch)
    return fmt::format("look {:.0f} mm beyond the tip before you fire", subject.needle().throw_mm);
  if (event.has_stayed) return "do not leave the needle in it: pull back and choose another way";
  if (is_bone) return "pull back a little and correct the direction, do not push on";
  return how_to_avoid(subject.task().guidance);
}

double harm_points(const HintSubject& subject, const metrics::HarmEvent& event) {
  const ScorePart* const part = subject.find_part("risk");
  const double lost = part != nullptr ? part->max_points - part->points : 0.0;
  switch (event.grade) {
    case tasks::Harm::kCritical:
      return 3.0 * kFaultPoints;
    case tasks::Harm::kMajor:
      return 2.0 * kFaultPoints;
    default:
      return lost;
  }
}

void add_entry_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const double points = subject.lost("entry");
  if (points <= 0.0) return;
  const metrics::AttemptMetrics& measured = subject.measured();
  const AccessJudgement& access = subject.judged.access;
  if (subject.task().entry_zone) {
    if (access.outside_zone_mm <= kNameable || subject.lost("access") > 0.0) return;  // the access says it
    advice.push_back({points,
                      fmt::format("The insertion point lay {:.0f} mm outside of the entry zone: move the needle {}.",
                                  access.outside_zone_mm, anatomy::direction_words(access.to_zone_P, " mm")),
                      measured.entry_s});
    return;
  }
  if (measured.entry_offset_P.norm() > kElsewhere_mm) {
    advice.push_back(
        {points,
         fmt::format("The insertion point lay {:.0f} mm from the planned one: find it {} before you insert "
                     "the needle.",
                     measured.entry_offset_P.norm(), found_by(subject.task().guidance)),
         measured.entry_s});
    return;
  }
  advice.push_back({points,
                    fmt::format("The insertion point was {}: move the needle {} before you insert it.",
                                anatomy::direction_words(measured.entry_offset_P, " mm too far"),
                                anatomy::direction_words(-measured.entry_offset_P, " mm")),
                    measured.entry_s});
}

void add_angle_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const double points = subject.lost("angle");
  if (points <= 0.0) return;
  const metrics::AttemptMetrics& measured = subject.measured();
  const Vec3 turn_P = measured.axis_P - subject.judged.expert.line_P.direction();
  const bool is_elsewhere = measured.entry_offset_P.norm() > kElsewhere_mm || measured.angle_deg > kOtherWay_deg;
  if (!(turn_P.norm() > 0.0) || is_elsewhere) return;  // the place tells more
  const Vec3 tilt_deg = measured.angle_deg * turn_P.normalized();
  advice.push_back(
      {points,
       fmt::format("The needle pointed {}: tilt it so that its tip points {}.",
                   anatomy::direction_words(tilt_deg, "° too far"), anatomy::direction_words(-tilt_deg, "° further")),
       measured.entry_s});
}

std::string margin_text(const AccessJudgement& access) {
  const double room_mm = access.margin_mm - access.missing_margin_mm;
  return fmt::format(
      "The way passed the {} at {}; it needs {:.0f} mm of room. Choose another entry or angle before you insert the "
      "needle.",
      anatomy::structure_words(access.margin_label),
      room_mm < kNoRoom_mm ? "less than 1 mm" : fmt::format("{:.0f} mm", room_mm), access.margin_mm);
}

/// Advice about the access: the worst fault of it.
void add_access_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const double points = subject.lost("access");
  if (points <= 0.0) return;
  const AccessJudgement& access = subject.judged.access;
  std::string text;
  const bool is_told =
      std::ranges::any_of(subject.judged.harms, [&](const auto& event) { return event.label == access.margin_label; });
  if (access.missing_margin_mm > kNameable && !is_told)
    text = margin_text(access);
  else if (access.outside_zone_mm > kNameable)
    text = fmt::format("The insertion point lay {:.0f} mm outside of the entry zone: move the needle {}.",
                       access.outside_zone_mm, anatomy::direction_words(access.to_zone_P, " mm"));
  else if (access.missing_away_mm > kNameable)
    text = fmt::format(
        "The tip ended {:.0f} mm from the {}, where large vessels run beside the target: choose a place that is "
        "{:.0f} mm away or more.",
        subject.task().target_away_mm - access.missing_away_mm, subject.task().target_away_from,
        subject.task().target_away_mm);
  else if (access.excess_angle_deg > kNameable)
    text = fmt::format("The needle met the skin too flat, by {:.0f}°: hold it steeper.", access.excess_angle_deg);
  else if (access.missing_organ_mm > kNameable)
    text = fmt::format(
        "The needle passed too little {}, by {:.0f} mm: choose a longer way through it, so that the "
        "channel closes.",
        anatomy::structure_words(subject.task().organ), access.missing_organ_mm);
  if (!text.empty()) advice.push_back({points, std::move(text), subject.measured().entry_s});
}

/// A fault that fails the attempt.
void add_level_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  if (!subject.judged.too_high_s) return;
  advice.push_back(
      {kFaultPoints,
       as_sentence(subject.task().highest_entry->reason) + ": count the levels by the landmarks and enter lower.",
       subject.judged.too_high_s});
}

void add_bevel_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const double points = subject.lost("bevel");
  if (points <= 0.0 || !subject.judged.bevel) return;
  const double across_deg = subject.judged.bevel->to_fibres_deg;
  advice.push_back(
      {points,
       fmt::format("The bevel stood {:.0f}° across the fibres of the {}{}: turn the needle about its axis before you "
                   "insert it, so that the bevel faces the patient's side.",
                   across_deg, anatomy::structure_words(subject.task().bevel->layer),
                   across_deg > subject.task().bevel->tolerance_deg ? " and cut them" : ""),
       subject.judged.bevel->time_s});
}

/// Why the skin was not numb: nothing was injected, or not there.
std::string numbness_advice(const HintSubject& subject) {
  const AttemptData& attempt = subject.judged.attempt;
  std::string why = "The skin was pierced without local anaesthetic: inject it first, where the needle will go in.";
  for (const tasks::Action& action : attempt.actions) {
    if (action.kind != tasks::ActionKind::kAnaesthetise || action.time_s > subject.measured().entry_s) continue;
    const std::string fault = why_not_numb(action, attempt.patient);
    if (fault.empty())
      return fmt::format(
          "The skin hurt: the anaesthetic was injected more than {:.0f} mm beside the insertion point. Put the tip on "
          "the skin where you will insert it, then inject.",
          PainWatch::kNumb_mm);
    why = fmt::format("The skin hurt: {}. Put the tip on the skin where you will insert it, then inject.", fault);
  }
  return why;
}

/// Travel beyond the path's length is either repeated after a retraction or beyond the target. Empty: the advice about
/// the target says it already.
std::string travel_hint(const HintSubject& subject, bool is_depth_told) {
  const metrics::AttemptMetrics& measured = subject.measured();
  const double path_mm = subject.judged.expert.line_P.length_mm();
  const double repeated_mm = measured.travel_mm - measured.deepest_mm;
  if (repeated_mm < kRepeatedTravel * (measured.travel_mm - path_mm)) {
    if (is_depth_told) return {};
    const bool has_image = subject.task().guidance != tasks::ImagingModality::kPalpation;
    return fmt::format("The needle went {:.0f} mm deep for a path of {:.0f} mm: {} and stop at the target.",
                       measured.deepest_mm, path_mm, has_image ? "follow the tip in the image" : "watch the depth");
  }
  const std::string entries =
      measured.entries > 1 ? fmt::format(" and pierced the skin {} times", measured.entries) : "";
  return fmt::format(
      "The needle travelled {:.0f} mm inside the body{} for a path of {:.0f} mm, {:.0f} mm of it after "
      "pulling back: set its direction before you insert it, so that it need not be corrected inside.",
      measured.travel_mm, entries, path_mm, repeated_mm);
}

std::string passes_hint(const HintSubject& subject) {
  const Judgement& judged = subject.judged;
  const std::size_t shots = judged.attempt.shots.size(), cores = judged.attempt.task.cores;
  if (judged.attempt.needle.is_biopsy && shots > cores)
    return fmt::format("The gun was fired {} times for {} {}: place the needle well before you fire, each shot wounds.",
                       shots, cores, cores == 1 ? "core" : "cores");
  return fmt::format("The {} was punctured {} times: stay in it, and correct the direction without leaving it.",
                     anatomy::structure_words(subject.task().organ), judged.bleeding ? judged.bleeding->passes : 0);
}

}  // namespace

void add_harm_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  for (const metrics::HarmEvent& event : subject.judged.harms) {
    if (event.grade == tasks::Harm::kMinor && event.label == subject.bone_of_stylet()) continue;  // the core says it
    const std::string reason = event.reason.empty() || event.is_graze ? std::string() : ": " + event.reason;
    advice.push_back({harm_points(subject, event),
                      fmt::format("{}, {:.0f} mm below the skin{}. {}.", as_sentence(metrics::harm_words(event)),
                                  event.depth_mm, reason, as_sentence(harm_advice(subject, event))),
                      event.begin_s});
  }
}

void add_way_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  add_level_advice(subject, advice);
  add_access_advice(subject, advice);
  add_entry_advice(subject, advice);
  add_angle_advice(subject, advice);
  add_bevel_advice(subject, advice);
}

void add_comfort_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const double points = subject.lost("comfort");
  if (points <= 0.0) return;
  const auto& harms = subject.judged.harms;
  for (const PainEvent& event : subject.judged.pain) {
    const bool is_told = std::ranges::any_of(harms, [&](const auto& harm) { return harm.label == event.label; });
    if (!event.label.empty() && is_told) continue;
    advice.push_back({points,
                      event.label.empty()
                          ? numbness_advice(subject)
                          : fmt::format("The tip met the {} at {:.0f} mm, which hurts: pull back a little and correct "
                                        "the direction, do not push on.",
                                        anatomy::structure_words(event.label), event.depth_mm),
                      event.time_s});
    return;
  }
}

void add_economy_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const bool is_depth_told = subject.lost("target") > 0.0 || subject.lost("core") > 0.0;
  if (const double points = subject.lost("length"); points > 0.0)
    if (std::string text = travel_hint(subject, is_depth_told); !text.empty())
      advice.push_back({points, std::move(text)});
  const bool has_finished = is_finished(subject.judged);
  if (const double points = subject.lost("time"); points > 0.0 && has_finished)
    advice.push_back({points, fmt::format("It took {:.0f} s from the skin to the target: plan the path first, then go "
                                          "on without stopping.",
                                          subject.measured().time_s)});
  if (const double points = subject.lost("dose"); points > 0.0 && has_finished)
    advice.push_back({points, fmt::format("The dose-area product was {:.1f} Gy cm²: press the pedal briefly, with few "
                                          "pulses a second, collimate, and work with the last image.",
                                          subject.find_part("dose")->value)});
  if (const double points = subject.lost("passes"); points > 0.0) advice.push_back({points, passes_hint(subject)});
  if (const double points = subject.lost("visibility"); points > 0.0)
    advice.push_back({points, fmt::format("The tip was in the image during {:.0f} % of the advance: stop when you lose "
                                          "it, and move the transducer until you see it again.",
                                          subject.find_part("visibility")->value)});
}

}  // namespace trocar::scoring
