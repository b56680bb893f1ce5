#include "scoring/detail/bleeding.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bitset>

#include "anatomy/structure_words.h"
#include "tasks/task_labels.h"
#include "volume/sampling.h"

namespace trocar::scoring {
namespace {

constexpr std::size_t kManyPasses = 3;  // from so many punctures of the surface on the risk is raised [assumed]
constexpr double kBack_mm = 3.0;        // the tip this far out of the organ has left it: tremor is no new puncture
constexpr double kAdvance_mm = 1.0;     // a tip that gets so much deeper on its way into the organ punctures it

constexpr std::array<std::string_view, 4> kInOrgan{"liver_lesion", "vessel", "bile_duct", "fluid"};  // fluid: cysts
constexpr std::array<std::string_view, 5> kBleeds{"spleen", "kidney", "liver", "lung", "organ"};

bool is_one_of(std::span<const std::string_view> tissues, std::string_view tissue) noexcept {
  return std::ranges::find(tissues, tissue) != tissues.end();
}

/// Labels outside the organ: a tip in one of them has left it. Lesions, vessels and ducts may lie inside.
std::bitset<256> labels_outside(const AttemptData& attempt, const tasks::TaskLabels& labels) {
  std::bitset<256> outside;
  outside.set();
  for (const anatomy::Label& label : attempt.patient.label_table.labels)
    outside[label.id] = labels.part(label.id) == tasks::TaskLabels::Part::kOther && !is_one_of(kInOrgan, label.tissue);
  return outside;
}

/// Punctures of the organ's surface by the tip, from outside. A tip that is pulled back into the organ makes no new
/// one.
std::size_t count_passes(const AttemptData& attempt, const tasks::TaskLabels& labels) {
  const std::bitset<256> outside = labels_outside(attempt, labels);
  std::size_t passes = 0;
  bool is_inside = false;
  Vec3 last_inside_P = Vec3::Zero();
  double shallowest_mm = -kAdvance_mm;  // since it left the organ
  for (const telemetry::TickSample& sample : attempt.samples) {
    if (!sample.rest_tip_mm.allFinite() || !(sample.depth_mm > 0.0)) {
      is_inside = false;
      shallowest_mm = -kAdvance_mm;
      continue;
    }
    const auto id = volume::sample_nearest<std::uint8_t>(attempt.patient.labels, sample.rest_tip_mm, 0);
    const auto part = labels.part(id);
    if (part == tasks::TaskLabels::Part::kOrgan || part == tasks::TaskLabels::Part::kTarget) {
      if (!is_inside && sample.depth_mm > shallowest_mm + kAdvance_mm) ++passes;
      is_inside = true;
      last_inside_P = sample.rest_tip_mm;
    } else if (is_inside && outside[id] && (sample.rest_tip_mm - last_inside_P).norm() > kBack_mm) {
      is_inside = false;
      shallowest_mm = sample.depth_mm;
    }
    if (!is_inside) shallowest_mm = std::min(shallowest_mm, sample.depth_mm);
  }
  return passes;
}

/// What needle or stylet did to vessels and to organs that bleed. `is_high`: to more than a vessel's surface.
std::vector<std::string> bleeding_harms(const Judgement& judged, bool& is_high) {
  std::vector<std::string> reasons;
  for (const metrics::HarmEvent& event : judged.harms) {
    const anatomy::Label* const label = judged.attempt.patient.label_table.find(event.label);
    if (label == nullptr) continue;
    const bool is_vessel = label->tissue == "vessel";
    if (!is_vessel && !(event.grade >= tasks::Harm::kMajor && is_one_of(kBleeds, label->tissue))) continue;
    is_high = is_high || !event.is_graze;
    reasons.push_back(is_vessel ? fmt::format("the needle {} a vessel, {}", event.is_graze ? "grazed" : "hit",
                                              anatomy::structure_words(event.label))
                                : metrics::harm_words(event));
  }
  return reasons;
}

}  // namespace

std::optional<Bleeding> judge_bleeding(const Judgement& judged) {
  const tasks::Task& task = judged.attempt.task;
  if (!(task.min_organ_path_mm > 0.0)) return std::nullopt;
  Bleeding bleeding;
  bleeding.passes = count_passes(judged.attempt, tasks::TaskLabels(task, judged.attempt.patient));
  const std::string organ = anatomy::structure_words(task.organ);
  bool is_high = false;
  bleeding.reasons = bleeding_harms(judged, is_high);
  if (bleeding.passes >= kManyPasses)
    bleeding.reasons.push_back(fmt::format("the {} was punctured {} times", organ, bleeding.passes));
  if (judged.access.missing_organ_mm > 0.0)
    bleeding.reasons.push_back(fmt::format("only {:.0f} mm of {} close the channel, {:.0f} mm are needed",
                                           task.min_organ_path_mm - judged.access.missing_organ_mm, organ,
                                           task.min_organ_path_mm));
  is_high = is_high || bleeding.reasons.size() > 1;
  if (!bleeding.reasons.empty()) bleeding.risk = is_high ? BleedingRisk::kHigh : BleedingRisk::kRaised;
  return bleeding;
}

}  // namespace trocar::scoring
