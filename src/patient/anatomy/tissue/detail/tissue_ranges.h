#pragma once

namespace trocar::anatomy::detail {

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

}  // namespace trocar::anatomy::detail
