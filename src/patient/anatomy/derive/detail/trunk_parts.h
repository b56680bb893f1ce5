#pragma once

#include "anatomy/derive/derive_choice.h"
#include "anatomy/derive/detail/derived_labels.h"

namespace trocar::anatomy::detail {

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
Vec3 trunk_axis(const VirtualPatient& patient);

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

}  // namespace trocar::anatomy::detail
