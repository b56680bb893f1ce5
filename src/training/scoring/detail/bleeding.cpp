#include "scoring/detail/bleeding.h"

#include <fmt/format.h>

#include <algorithm>

#include "anatomy/structure_words.h"
#include "tasks/task_labels.h"
#include "volume/sampling.h"

namespace trocar::scoring {
namespace {

constexpr std::size_t kManyPasses = 3;  // from so many punctures of the surface on the risk is raised [assumed]
constexpr double kBack_mm = 3.0;        // the tip this far out of the organ has left it: tremor is no new puncture

/// Punctures of the organ's surface by the tip, from outside. Target and vessels inside belong to the organ.
std::size_t count_passes(const AttemptData& attempt, const tasks::TaskLabels& labels) {
  std::size_t passes = 0;
  bool is_inside = false;
  Vec3 last_inside_P = Vec3::Zero();
  for (const telemetry::TickSample& sample : attempt.samples) {
    if (!sample.tip_mm.allFinite() || !(sample.depth_mm > 0.0)) {
      is_inside = false;
      continue;
    }
    const auto id = volume::sample_nearest<std::uint8_t>(attempt.patient.labels, sample.tip_mm, 0);
    const bool is_organ =
        labels.part(id) == tasks::TaskLabels::Part::kOrgan || labels.part(id) == tasks::TaskLabels::Part::kTarget;
    if (is_organ) {
      if (!is_inside) ++passes;
      is_inside = true;
      last_inside_P = sample.tip_mm;
    } else if (is_inside && (sample.tip_mm - last_inside_P).norm() > kBack_mm &&
               labels.part(id) == tasks::TaskLabels::Part::kOther) {
      is_inside = false;
    }
  }
  return passes;
}

/// Vessels that needle or stylet touched, by label.
std::vector<std::string> touched_vessels(const Judgement& judged) {
  std::vector<std::string> names;
  for (const metrics::HarmEvent& event : judged.harms) {
    const anatomy::Label* const label = judged.attempt.patient.label_table.find(event.label);
    if (label != nullptr && label->tissue == "vessel" && !event.is_graze) names.push_back(event.label);
  }
  return names;
}

}  // namespace

std::optional<Bleeding> judge_bleeding(const Judgement& judged) {
  const tasks::Task& task = judged.attempt.task;
  if (!(task.min_organ_path_mm > 0.0)) return std::nullopt;
  Bleeding bleeding;
  bleeding.passes = count_passes(judged.attempt, tasks::TaskLabels(task, judged.attempt.patient));
  const std::string organ = anatomy::structure_words(task.organ);
  const std::vector<std::string> vessels = touched_vessels(judged);
  for (const std::string& vessel : vessels)
    bleeding.reasons.push_back(fmt::format("the needle hit a vessel, {}", anatomy::structure_words(vessel)));
  if (bleeding.passes >= kManyPasses)
    bleeding.reasons.push_back(fmt::format("the {} was punctured {} times", organ, bleeding.passes));
  if (judged.access.missing_organ_mm > 0.0)
    bleeding.reasons.push_back(fmt::format("only {:.0f} mm of {} close the channel, {:.0f} mm are needed",
                                           task.min_organ_path_mm - judged.access.missing_organ_mm, organ,
                                           task.min_organ_path_mm));
  const bool is_high = !vessels.empty() || bleeding.reasons.size() > 1;
  if (!bleeding.reasons.empty()) bleeding.risk = is_high ? BleedingRisk::kHigh : BleedingRisk::kRaised;
  return bleeding;
}

}  // namespace trocar::scoring
