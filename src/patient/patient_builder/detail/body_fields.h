#pragma once

#include "anatomy/patient.h"
#include "volume/grid.h"

namespace trocar::patient_builder::detail {

/// Location of a point inside the body that CT values alone do not determine: smooth fields on a coarse grid (3 mm).
struct BodyFields {
  /// Negative in the trunk's wall: within reach of the subcutaneous fat or of the spine and pelvis, where lean tissue
  /// is muscle. Positive deeper, where it may be bowel, mesentery or an organ without a label, and in the spine's
  /// discs.
  volume::FloatGrid wall_mm;
  /// Signed distance to the surface of the aerated lungs, their vessels inside; infinite if there are none.
  volume::FloatGrid lung_mm;
};

/// Finds the fields from the smoothed CT, the labels known so far and the signed distance to the skin.
BodyFields find_body_fields(const volume::CtGrid& smooth_ct, const volume::LabelGrid& labels,
                            const anatomy::LabelTable& table, const volume::FloatGrid& skin_distance_mm);

/// The CT with its noise reduced by binomial filters (1 2 1)/4 along the axes that are sampled finely enough: two
/// passes below 1.2 mm, one below 2.5 mm, none above. Standard deviation of the kernel about 0.7..1.2 mm.
volume::CtGrid smooth_hu(const volume::CtGrid& ct);

// Adipose tissue -190..-30 HU and skeletal muscle -29..150 HU: the ranges of CT body composition studies
// (doi 10.1038/s41598-025-96238-6, table 1; PMC4043057 measures -140..-30 for pure fat).
inline constexpr int kFatAboveHu = -190;
inline constexpr int kFatUpToHu = -30;
inline constexpr int kMuscleUpToHu = 150;
inline constexpr int kGasBelowHu = -300;  // assumed: gas and aerated lung below, partial volume above
inline constexpr int kBoneAboveHu = 250;  // assumed: above enhanced vessels of the portal venous phase
inline constexpr int kBonePeakHu = 400;   // assumed: a part without any voxel above is contrast agent, not bone
/// Skin and subcutis: no muscle lies this close below the surface. Assumed: skin about 2 mm and as much fat.
inline constexpr double kSubcutisMm = 4.0;

}  // namespace trocar::patient_builder::detail
