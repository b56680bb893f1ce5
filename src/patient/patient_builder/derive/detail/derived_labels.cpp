#include "patient_builder/derive/detail/derived_labels.h"

#include <algorithm>

#include "core/result.h"

namespace trocar::patient_builder::detail {

DerivedLabels::DerivedLabels(anatomy::VirtualPatient& patient, const anatomy::KnownStructures& known)
    : patient_(patient), known_(known), boxes_(find_label_boxes(patient.labels)) {
  for (const anatomy::Label& label : patient.label_table.labels)
    is_soft_[label.id] = label.tissue == "adipose" || label.tissue == "muscle" || label.tissue == "soft_tissue";
}

std::uint8_t DerivedLabels::add(std::string_view name) {
  const anatomy::KnownStructure* structure = known_.find(name);
  TROCAR_ASSERT(structure != nullptr && !is_labelled(name));
  std::vector<anatomy::Label>& labels = patient_.label_table.labels;
  const int id = labels.empty() ? 1 : labels.back().id + 1;
  if (id > 255) return 0;
  labels.push_back({static_cast<std::uint8_t>(id), std::string(name), structure->tissue, structure->color, true});
  return static_cast<std::uint8_t>(id);
}

std::uint8_t DerivedLabels::find_or_add(std::string_view name) {
  const anatomy::Label* label = patient_.label_table.find(name);
  return label != nullptr ? label->id : add(name);
}

bool DerivedLabels::has_tissue(std::uint8_t id, std::string_view tissue) const noexcept {
  const anatomy::Label* label = patient_.label_table.find(id);
  return label != nullptr && label->tissue == tissue;
}

void DerivedLabels::finish() {
  const LabelBoxes now = find_label_boxes(patient_.labels);
  std::erase_if(patient_.label_table.labels, [&](const anatomy::Label& label) {
    const bool was_empty = boxes_.voxels[label.id] == 0 && !label.is_derived;
    return now.voxels[label.id] == 0 && !was_empty;
  });
}

}  // namespace trocar::patient_builder::detail
