#include "anatomy/complete_labels.h"

#include <algorithm>
#include <array>

#include "anatomy/derive/derive_structures.h"
#include "anatomy/detail/fill_unlabelled.h"
#include "anatomy/known_structures.h"
#include "core/files/data_dir.h"
#include "core/part_of_progress.h"

namespace trocar::anatomy {

Status check_completed_names(const KnownStructures& known) {
  TROCAR_TRY_STATUS(detail::check_fill_names(known));
  return check_derived_names(known);
}

std::vector<std::string> complete_labels(VirtualPatient& patient, const KnownStructures& known,
                                         const DeriveChoice& derive, const Progress& progress) {
  report(progress, "fat and muscle", 0.0);
  detail::fill_unlabelled(patient.ct, patient.skin_distance_mm, patient.labels, patient.label_table, known);
  return derive_structures(patient, known, derive, part_of(progress, 0.4, 1.0));
}

namespace {

/// Keeps the labels for which `is_kept` is true, under the ids that `id_of(label, number)` gives; the others become 0.
void keep_labels(VirtualPatient& patient, const auto& is_kept, const auto& id_of) {
  std::array<std::uint8_t, 256> kept{};
  std::vector<Label> labels;
  for (Label& label : patient.label_table.labels) {
    if (!is_kept(label)) continue;
    const std::uint8_t id = id_of(label, labels.size() + 1);
    kept[label.id] = id;
    label.id = id;
    labels.push_back(std::move(label));
  }
  patient.label_table.labels = std::move(labels);
  for (std::uint8_t& voxel : patient.labels.voxels) voxel = kept[voxel];
}

}  // namespace

Result<VirtualPatient> with_segmented_only(const VirtualPatient& full, std::span<const std::string_view> tissues,
                                           const Progress& progress) {
  TROCAR_TRY(const std::filesystem::path data_folder, checked_data_dir());
  TROCAR_TRY(const KnownStructures known, KnownStructures::load(data_folder));
  TROCAR_TRY_STATUS(check_completed_names(known));
  VirtualPatient partly = full;
  keep_labels(
      partly,
      [&](const Label& label) {
        return !label.is_derived && std::ranges::find(tissues, label.tissue) != tissues.end();
      },
      [](const Label&, std::size_t number) { return static_cast<std::uint8_t>(number); });
  complete_labels(partly, known, derivable_in(full.label_table), progress);
  partly.content_hash = hash_patient(partly);
  return partly;
}

void remove_found_labels(VirtualPatient& patient) {
  keep_labels(
      patient, [](const Label& label) { return !label.is_derived || is_derivable(label.name); },
      [](const Label& label, std::size_t) { return label.id; });
  patient.content_hash = hash_patient(patient);
}

}  // namespace trocar::anatomy
