#include "scoring/core_sample.h"

#include <algorithm>
#include <cmath>

#include "scoring/score.h"
#include "tasks/task_labels.h"
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

}  // namespace trocar::scoring
