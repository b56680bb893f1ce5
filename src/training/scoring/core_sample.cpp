#include "scoring/core_sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>

#include "anatomy/structure_words.h"
#include "scoring/score.h"
#include "tasks/fit_to_patient.h"
#include "volume/sampling.h"

namespace trocar::scoring {
namespace {

constexpr double kCoreStep_mm = 0.25;

std::uint8_t label_id(const anatomy::VirtualPatient& patient, const Vec3& p_P) noexcept {
  return volume::sample_nearest<std::uint8_t>(patient.labels, p_P, 0);
}

/// Calls visit(middle_mm, length_mm) for each step of a stretch; not if it is empty.
template <class Visit>
void walk(double from_mm, double to_mm, Visit visit) {
  if (!(to_mm > from_mm)) return;
  const int steps = static_cast<int>(std::ceil((to_mm - from_mm) / kCoreStep_mm));
  const double length_mm = (to_mm - from_mm) / steps;
  for (int step = 0; step < steps; ++step) visit(from_mm + (step + 0.5) * length_mm, length_mm);
}

void add_to_pieces(std::vector<CorePiece>& pieces, const anatomy::Label* label, double length_mm) {
  const std::string name = label != nullptr ? label->name : "unlabelled";
  const double from_mm = pieces.empty() ? 0.0 : pieces.back().to_mm;
  if (!pieces.empty() && pieces.back().label == name) {
    pieces.back().to_mm += length_mm;
  } else {
    pieces.push_back({name, label != nullptr ? label->tissue : "", from_mm, from_mm + length_mm});
  }
}

void add_to_sums(BiopsyCore& core, tasks::TaskLabels::Part part, double length_mm) {
  switch (part) {
    case tasks::TaskLabels::Part::kTarget:
      core.target_mm += length_mm;
      break;
    case tasks::TaskLabels::Part::kOrgan:
      core.organ_mm += length_mm;
      break;
    case tasks::TaskLabels::Part::kVessel:
      core.vessel_mm += length_mm;
      break;
    case tasks::TaskLabels::Part::kOther:
      core.other_mm += length_mm;
      break;
  }
}

double shot_mm(const tasks::TaskLabels& labels, const anatomy::VirtualPatient& patient, const tasks::Needle& needle,
               const Vec3& tip_P, const Vec3& axis_P) {
  double shot = needle.throw_mm;
  walk(0.0, needle.throw_mm, [&](double beyond_tip_mm, double length_mm) {
    if (labels.is_bone(label_id(patient, tip_P + beyond_tip_mm * axis_P)))
      shot = std::min(shot, beyond_tip_mm - length_mm / 2.0);
  });
  return shot;
}

}  // namespace

CorePart part_of(const tasks::Task& task, const anatomy::VirtualPatient& patient, const CorePiece& piece) {
  const anatomy::Label* label = patient.label_table.find(std::string_view(piece.label));
  if (label == nullptr) return CorePart::kOther;
  switch (tasks::TaskLabels(task, patient).part(label->id)) {
    case tasks::TaskLabels::Part::kTarget:
      return CorePart::kTarget;
    case tasks::TaskLabels::Part::kOrgan:
      return CorePart::kOrgan;
    case tasks::TaskLabels::Part::kVessel:
      return CorePart::kVessel;
    case tasks::TaskLabels::Part::kOther:
      break;
  }
  return CorePart::kOther;
}

double stylet_throw_mm(const tasks::Task& task, const anatomy::VirtualPatient& patient, const tasks::Needle& needle,
                       const Vec3& tip_P, const Vec3& axis_P) {
  return shot_mm(tasks::TaskLabels(task, patient), patient, needle, tip_P, axis_P);
}

BiopsyCore take_core(const tasks::Task& task, const anatomy::VirtualPatient& patient, const tasks::Needle& needle,
                     const Vec3& tip_P, const Vec3& axis_P) {
  const tasks::TaskLabels labels(task, patient);
  BiopsyCore core;
  core.tip_P = tip_P;
  core.axis_P = axis_P;

  const double shot = shot_mm(labels, patient, needle, tip_P, axis_P);
  const double notch_end_mm = shot - needle.dead_space_mm;
  const double notch_begin_mm =
      std::max(0.0, notch_end_mm - needle.notch_mm);  // the part inside the cannula takes no tissue
  walk(notch_begin_mm, notch_end_mm, [&](double beyond_tip_mm, double length_mm) {
    const std::uint8_t id = label_id(patient, tip_P + beyond_tip_mm * axis_P);
    add_to_pieces(core.pieces, patient.label_table.find(id), length_mm);
    add_to_sums(core, labels.part(id), length_mm);
  });

  walk(0.0, std::min(shot + kCoreStep_mm, needle.throw_mm),
       [&](double beyond_tip_mm, double) {  // the bone that stopped it
         const std::uint8_t id = label_id(patient, tip_P + beyond_tip_mm * axis_P);
         if (labels.harm(id) == tasks::Harm::kNone) return;
         const std::string& name = patient.label_table.find(id)->name;
         auto& found = core.risks_in_throw;
         if (std::find(found.begin(), found.end(), name) == found.end()) found.push_back(name);
       });
  return core;
}

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
