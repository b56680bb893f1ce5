#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "anatomy/known_structures.h"
#include "anatomy/patient.h"
#include "patient_builder/derive/derive_structures.h"
#include "patient_builder/detail/label_boxes.h"

namespace trocar::patient_builder::detail {

/// Adds derived labels to a patient that is being built. Only fat, muscle and other soft tissue are overwritten, unless
/// a function says otherwise. Precondition: the structures that are added are known.
class DerivedLabels {
 public:
  DerivedLabels(anatomy::VirtualPatient& patient, const anatomy::KnownStructures& known);

  const anatomy::VirtualPatient& patient() const noexcept { return patient_; }
  const volume::GridGeometry& geometry() const noexcept { return patient_.labels.geometry; }
  const LabelBoxes& boxes() const noexcept { return boxes_; }  ///< Of the labels before the derivations.
  std::uint8_t at(std::size_t offset) const noexcept { return patient_.labels.voxels[offset]; }

  /// True if the segmentation has this structure: then it is not derived.
  bool is_labelled(std::string_view name) const noexcept { return patient_.label_table.find(name) != nullptr; }
  /// The id of a new derived label, 0 if all ids are used. The row is removed by finish() if it stays empty.
  std::uint8_t add(std::string_view name);
  std::uint8_t find_or_add(std::string_view name);
  /// True if a label can give its voxel to a derived one: fat, muscle, soft tissue.
  bool is_soft(std::uint8_t id) const noexcept { return is_soft_[id]; }
  bool has_tissue(std::uint8_t id, std::string_view tissue) const noexcept;
  /// Sets a voxel of soft tissue; other voxels stay. Id 0 changes nothing.
  void paint(std::size_t offset, std::uint8_t id) noexcept {
    if (id != 0 && is_soft_[at(offset)]) patient_.labels.voxels[offset] = id;
  }
  /// Sets a voxel of any label.
  void replace(std::size_t offset, std::uint8_t id) noexcept {
    if (id != 0) patient_.labels.voxels[offset] = id;
  }
  /// Removes rows of the label table without voxels that were added here or emptied here.
  void finish();

 private:
  anatomy::VirtualPatient& patient_;
  const anatomy::KnownStructures& known_;
  LabelBoxes boxes_;
  std::array<bool, 256> is_soft_{};
};

/// Adds bile_ducts inside the liver, in front of the labelled portal vein's branches.
void derive_bile_ducts(DerivedLabels& labels, const DeriveChoice& choice);

/// Adds what is chosen of peritoneum, pleural_recess, inferior_epigastric_zone and neurovascular_bundle.
void derive_wall_structures(DerivedLabels& labels, const DeriveChoice& choice);

/// The region of the organs in the peritoneal cavity, on a grid of 4 mm.
struct PeritonealRegion {
  std::array<bool, 256> is_organ{};  ///< By label id.
  volume::FloatGrid distance_mm;     ///< Signed distance to the organs with the narrow spaces between them.
  IndexBox box;                      ///< Around the organs, in the labels' grid.
};
/// Empty box: no such organ is labelled.
PeritonealRegion find_peritoneal_region(const DerivedLabels& labels);

/// The centroid of the body.
Vec3 trunk_axis(const anatomy::VirtualPatient& patient);

void derive_peritoneum(DerivedLabels& labels, const PeritonealRegion& region);
void derive_pleural_recess(DerivedLabels& labels, const PeritonealRegion& region);
void derive_epigastric_zone(DerivedLabels& labels);
void derive_neurovascular_bundle(DerivedLabels& labels);

/// Samples a coarse field at voxels of the labels' grid; both lie along P.
class CoarseField {
 public:
  CoarseField(const volume::FloatGrid& field, const volume::GridGeometry& fine);
  double at(const volume::Index3& ijk) const noexcept;

 private:
  const volume::FloatGrid& field_;
  Vec3 scale_, offset_;
};

}  // namespace trocar::patient_builder::detail
