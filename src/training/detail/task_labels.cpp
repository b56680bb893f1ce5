#include "training/detail/task_labels.h"

#include <algorithm>
#include <cstring>

namespace trocar {
namespace {

bool occurs(const VirtualPatient& patient, std::uint8_t label_id) {
  const auto& voxels = patient.labels.voxels;
  return !voxels.empty() && std::memchr(voxels.data(), label_id, voxels.size()) != nullptr;
}

}  // namespace

TaskLabels::TaskLabels(const Task& task, const VirtualPatient& patient) {
  const auto& labels = patient.label_table.labels;
  is_parenchymal_ = std::none_of(labels.begin(), labels.end(), [&](const Label& label) {
    return is_target(task, label) && occurs(patient, label.id);
  });
  for (const Label& label : labels) {
    if (is_target(task, label)) {
      parts_[label.id] = Part::kTarget;
    } else if (is_organ(task, label)) {
      parts_[label.id] = is_parenchymal_ ? Part::kTarget : Part::kOrgan;
    } else if (label.tissue == "vessel") {
      parts_[label.id] = Part::kVessel;
    }
    risks_[label.id] = find_risk(task, label);
    is_bone_[label.id] = label.tissue == "bone";
  }
}

}  // namespace trocar
