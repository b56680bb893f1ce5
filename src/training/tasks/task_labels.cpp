#include "tasks/task_labels.h"

namespace trocar::tasks {

TaskLabels::TaskLabels(const Task& task, const anatomy::VirtualPatient& patient) {
  const auto& labels = patient.label_table.labels;
  is_parenchymal_ = trocar::tasks::is_parenchymal(task, patient);
  for (const anatomy::Label& label : labels) {
    if (is_target(task, label)) {
      parts_[label.id] = Part::kTarget;
    } else if (is_organ(task, label)) {
      parts_[label.id] = is_parenchymal_ ? Part::kTarget : Part::kOrgan;
    } else if (label.tissue == "vessel") {
      parts_[label.id] = Part::kVessel;
    }
    risks_[label.id] = find_risk(task, label);
    harms_[label.id] = find_harm(task, label).grade;
    is_bone_[label.id] = label.tissue == "bone";
  }
}

}  // namespace trocar::tasks
