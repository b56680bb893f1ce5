// Advice about the place that the needle reached: the target, the cores, what came back.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "anatomy/structure_words.h"
#include "scoring/detail/hints.h"
#include "telemetry/tick_sample.h"
#include "volume/sampling.h"

namespace trocar::scoring {
namespace {

constexpr double kFullCore = 0.8;     // of the possible length: nothing to improve in this core
constexpr double kFarBeside_mm = 15;  // from here on the depth is not worth telling: the direction was wrong
constexpr double kLookAhead_mm = 0.5;

/// "5 mm short of the target, 4 mm too far towards the feet", with the advice; empty if there is nothing to tell.
struct Correction {
  std::string deviation;
  std::string advice;

  bool is_empty() const noexcept { return deviation.empty(); }
};

/// True if the needle can go straight on from where it ended.
bool is_clear_ahead(const HintSubject& subject, const Vec3& tip_P, const Vec3& axis_P, double ahead_mm) {
  const anatomy::VirtualPatient& patient = subject.judged.attempt.patient;
  for (double at_mm = kLookAhead_mm; at_mm <= ahead_mm; at_mm += kLookAhead_mm) {
    const anatomy::Label* const label = anatomy::find_label(patient, tip_P + at_mm * axis_P);
    if (label != nullptr && tasks::find_harm(subject.task(), *label).grade > tasks::Harm::kNone) return false;
  }
  return true;
}

/// `offset_P`: is minus wanted. `tip_P`, `axis_P`: of the needle that has to be corrected.
Correction correct(const HintSubject& subject, const Vec3& offset_P, const Vec3& tip_P, const Vec3& axis_P) {
  const double deeper_mm = offset_P.dot(axis_P);
  const Vec3 sideways_P = offset_P - deeper_mm * axis_P;
  const double least_mm =
      std::max(kNameable, anatomy::kSecondDirection * std::max(std::abs(deeper_mm), sideways_P.norm()));
  std::vector<std::string> deviations;
  std::vector<std::string> advice;
  if (sideways_P.norm() >= least_mm) {
    deviations.push_back(anatomy::direction_words(sideways_P, " mm too far"));
    advice.push_back("aim " + anatomy::direction_words(-sideways_P, " mm further"));
  }
  if (std::abs(deeper_mm) >= least_mm && sideways_P.norm() < kFarBeside_mm) {
    deviations.push_back(
        fmt::format("{:.0f} mm {}", std::abs(deeper_mm), deeper_mm < 0.0 ? "short of the target" : "too deep"));
    if (deeper_mm > 0.0)
      advice.push_back(fmt::format("stop {:.0f} mm earlier", deeper_mm));
    else if (sideways_P.norm() >= least_mm || is_clear_ahead(subject, tip_P, axis_P, -deeper_mm))
      advice.push_back(fmt::format("advance {:.0f} mm further", -deeper_mm));
    else
      advice.push_back("do not push on, something is in the way: pull back and take another direction");
  }
  return {fmt::format("{}", fmt::join(deviations, ", ")), fmt::format("{}", fmt::join(advice, ", "))};
}

Correction correct_tip(const HintSubject& subject) {
  const Judgement& judged = subject.judged;
  const bool is_from_plan = judged.is_planned_place || subject.needle().is_biopsy || !judged.to_target_P;
  const Vec3 offset_P = is_from_plan ? judged.measured.target_offset_P : Vec3(-*judged.to_target_P);
  return correct(subject, offset_P, judged.measured.tip_P, judged.measured.axis_P);
}

void add_core_hint(const HintSubject& subject, const BiopsyCore& core, double points, std::vector<Advice>& advice) {
  const Judgement& judged = subject.judged;
  const std::string bone = subject.bone_of_stylet();
  if (core.pieces.empty() || !bone.empty()) {  // deeper insertion would be wrong advice
    advice.push_back({points,
                      fmt::format("{}: the stylet hit {}. Choose an insertion point and a direction that pass beside "
                                  "it.",
                                  core.pieces.empty() ? "No tissue was taken" : "The core is incomplete",
                                  bone.empty() ? "bone" : "the " + anatomy::structure_words(bone)),
                      core.time_s});
    return;
  }
  const double middle_mm = subject.needle().notch_middle_mm();
  const Vec3 path_P = judged.expert.line_P.direction();
  const Vec3 notch_offset_P = core.tip_P + middle_mm * core.axis_P - (judged.expert.line_P.b + middle_mm * path_P);
  if (core.target_mm <= 0.0 && notch_offset_P.norm() > kElsewhere_mm) {
    advice.push_back({points,
                      fmt::format("The core was taken {:.0f} mm from the {}: find the target {} and plan the way anew.",
                                  notch_offset_P.norm(), subject.target_name(), found_by(subject.task().guidance)),
                      core.time_s});
    return;
  }
  const Correction correction = correct(subject, notch_offset_P, core.tip_P, core.axis_P);
  std::string what = fmt::format("The core missed the {}", subject.target_name());
  if (core.target_mm >= kFullCore * judged.possible_core_mm)
    what = "The core is complete, but the notch was off the target";
  else if (core.target_mm > 0.0)
    what = fmt::format("The core holds only {:.0f} mm of {} of {:.0f} mm possible", core.target_mm,
                       subject.target_name(), judged.possible_core_mm);
  const std::string why = correction.is_empty() ? "."
                                                : fmt::format(": the notch lay {}; {} before you fire.",
                                                              correction.deviation, correction.advice);
  advice.push_back({points, what + why, core.time_s});
}

/// Cores that were not taken.
void add_missing_cores(const HintSubject& subject, double points, std::vector<Advice>& advice) {
  const std::size_t taken = subject.judged.cores.size(), wanted = subject.task().cores;
  const char* const how = subject.needle().is_coaxial ? "load the gun again while the coaxial needle stays in place"
                                                      : "withdraw the needle, load the gun and puncture again";
  advice.push_back({points,
                    fmt::format("Only {} of {} cores {} taken: {}, and fire once more.", taken, wanted,
                                taken == 1 ? "was" : "were", how),
                    subject.judged.cores.back().time_s});
}

void add_biopsy_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const Judgement& judged = subject.judged;
  const double lost_core = subject.lost("core"), lost_target = subject.lost("target");
  if (judged.cores.empty()) {
    const Correction correction = correct_tip(subject);
    const std::string where =
        lost_target > 0.0 && !correction.is_empty() ? fmt::format(" The tip stopped {}.", correction.deviation) : "";
    const char* const what = judged.attempt.shots.empty() ? "No core was taken" : "The gun was fired outside the body";
    advice.push_back({kFaultPoints,
                      fmt::format("{}: bring the tip to the target, hold it still and fire the gun.{}", what, where),
                      subject.measured().end_s});
    return;
  }
  const auto worst = std::min_element(judged.cores.begin(), judged.cores.end(),
                                      [](const auto& a, const auto& b) { return a.target_mm < b.target_mm; });
  const bool is_full = worst->target_mm >= kFullCore * judged.possible_core_mm;
  const bool is_missing = lost_core > 0.0 && judged.cores.size() < subject.task().cores;
  if (is_missing) add_missing_cores(subject, lost_core, advice);
  if (is_missing && is_full) return;
  if ((lost_core > 0.0 && !is_full) || worst->pieces.empty())
    add_core_hint(subject, *worst, lost_core + lost_target, advice);
  else if (lost_target > 0.0 || lost_core > 0.0)
    add_core_hint(subject, *worst, lost_target + lost_core, advice);
}

std::string substance_sentence(const HintSubject& subject, const tasks::Action& looked) {
  const char* const wanted = tasks::substance_words(subject.task().confirmed_by);
  return looked.result.substance == tasks::Substance::kNothing
             ? fmt::format("No {}", wanted)
             : fmt::format("Not {} but {}", wanted, tasks::substance_words(looked.result.substance));
}

/// The tip was where it has to be, but pressed on a wall that had not given way.
bool has_pressed_only(const HintSubject& subject, double time_s) {
  const AttemptData& attempt = subject.judged.attempt;
  const auto sample = std::find_if(attempt.samples.begin(), attempt.samples.end(),
                                   [&](const telemetry::TickSample& one) { return one.time_s >= time_s; });
  if (sample == attempt.samples.end() || telemetry::pierced_rest_tip_mm(*sample) == sample->rest_tip_mm) return false;
  const anatomy::Label* const label = anatomy::find_label(attempt.patient, sample->rest_tip_mm);
  return label != nullptr && tasks::is_target(attempt.task, *label);
}

}  // namespace

void add_target_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  if (subject.needle().is_biopsy) return add_biopsy_advice(subject, advice);
  const double points = subject.lost("target");
  if (points <= 0.0) return;
  if (subject.judged.target_mm > kElsewhere_mm) {
    advice.push_back({points,
                      fmt::format("The tip ended {:.0f} mm from the {}: find the target {} and plan the way anew.",
                                  subject.judged.target_mm, subject.target_name(), found_by(subject.task().guidance)),
                      subject.measured().end_s});
    return;
  }
  const Correction correction = correct_tip(subject);
  const std::string how =
      correction.is_empty() ? "." : fmt::format(", {}: {}.", correction.deviation, correction.advice);
  advice.push_back({points,
                    fmt::format("The tip missed the {} by {:.0f} mm{}", subject.target_name(),
                                std::max(1.0, subject.judged.target_mm), how),
                    subject.measured().end_s});
}

void add_confirmation_advice(const HintSubject& subject, std::vector<Advice>& advice) {
  const double points = subject.lost("confirmation");
  if (points <= 0.0) return;
  const char* const wanted = tasks::substance_words(subject.task().confirmed_by);
  const auto is_look = [](const tasks::Action& action) {
    return action.kind == tasks::ActionKind::kDrawStylet || action.kind == tasks::ActionKind::kAspirate;
  };
  const auto& actions = subject.judged.attempt.actions;
  const auto looked = std::find_if(actions.rbegin(), actions.rend(), is_look);
  if (subject.judged.confirmed_s) {
    advice.push_back(
        {points,
         fmt::format("The {} came slowly: only a part of the bevel was in it. Turn the needle or advance it "
                     "by a millimetre or two.",
                     wanted),
         subject.judged.confirmed_s});
  } else if (looked == actions.rend() && has_pressed_only(subject, subject.measured().end_s)) {
    advice.push_back(
        {points,
         fmt::format("The tip pressed on the wall of the {}, which had not given way: advance until it "
                     "does, then {} and look whether {} comes.",
                     subject.target_name(), subject.has_stylet() ? "remove the stylet" : "aspirate", wanted),
         subject.measured().end_s});
  } else if (looked == actions.rend()) {
    advice.push_back({points,
                      fmt::format("Position not confirmed: {} at the target and look whether {} comes.",
                                  subject.has_stylet() ? "remove the stylet" : "aspirate", wanted),
                      subject.measured().end_s});
  } else if (has_pressed_only(subject, looked->time_s)) {
    advice.push_back(
        {points,
         fmt::format("{} came back: the tip pressed on the wall, which had not given way. Advance until it does, "
                     "then look again.",
                     substance_sentence(subject, *looked)),
         looked->time_s});
  } else {
    advice.push_back({points,
                      fmt::format("{} came back: the needle was in the wrong place. {} and look again.",
                                  substance_sentence(subject, *looked),
                                  subject.has_stylet() ? "Reinsert the stylet, correct the tip" : "Correct the tip"),
                      looked->time_s});
  }
}

}  // namespace trocar::scoring
