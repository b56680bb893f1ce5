#include <algorithm>
#include <array>

#include "tasks/operator.h"
#include "volume/sampling.h"

namespace trocar::tasks {
namespace {

/// Largest number that a phase of the task asks for; 0: none does.
double asked_number(const Task& task, ConditionKind kind) {
  double most = 0.0;
  for (const Phase& phase : task.phases)
    for (const Condition& condition : phase.done)
      if (condition.kind == kind) most = std::max(most, condition.number);
  return most;
}

}  // namespace

OperatorActions actions_for(const Task& task, const Needle& needle) {
  OperatorActions actions;
  actions.gives_anaesthetic = task.pain.needs_anaesthesia;
  if (task.confirmed_by != Substance::kNothing)
    actions.confirms = needle.stylet_diameter_mm > 0.0 ? ActionKind::kDrawStylet : ActionKind::kAspirate;
  actions.awaited = task.confirmed_by;
  actions.wire_mm = asked_number(task, ConditionKind::kWire);
  actions.cores = task.cores;
  actions.loads_inside = needle.is_coaxial;
  return actions;
}

double landmark_cover_mm(const Task& task, const anatomy::VirtualPatient& patient, const Segment& path_P) {
  if (task.guidance != ImagingModality::kPalpation && !task.landmark_zone) return 0.0;
  std::array<bool, 256> is_fat{}, is_body{};
  for (const anatomy::Label& label : patient.label_table.labels) {
    is_fat[label.id] = label.tissue == "adipose";
    is_body[label.id] = label.tissue != "skin";
  }
  constexpr double kStep_mm = 0.5;
  double cover_mm = 0.0;
  for (double at_mm = 0.0; at_mm < path_P.length_mm(); at_mm += kStep_mm) {
    const Vec3 p_P = path_P.a + at_mm * path_P.direction();
    const std::uint8_t id = volume::sample_nearest(patient.labels, p_P, std::uint8_t{0});
    if (is_fat[id]) cover_mm += kStep_mm;
    if (is_body[id] && !is_fat[id]) break;  // a muscle: what lies below it is not felt
  }
  return cover_mm;
}

}  // namespace trocar::tasks
