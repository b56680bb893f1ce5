#include "anatomy/detail/body_regions.h"

#include <array>

#include "anatomy/detail/tissue_ranges.h"
#include "volume/distance.h"
#include "volume/morphology.h"
#include "volume/resample.h"
#include "volume/sampling.h"

namespace trocar::detail {
namespace {

// Assumed lengths.
constexpr double kCoarseMm = 3.0;
constexpr double kWallMm = 30.0;        // abdominal wall or intercostal muscles below the subcutaneous fat
constexpr double kSpineReachMm = 40.0;  // erector spinae and psoas around the spine
constexpr double kThickBoneMm = 8.0;    // radius that fits into a vertebral body or the pelvis, not into a rib
constexpr double kFatSheetMm = 2.0;     // radius that cuts the fine ways from subcutaneous to visceral fat
constexpr double kLungVesselMm = 6.0;   // vessels up to this radius belong to the lung
constexpr double kMinLungMl = 20.0;
constexpr double kLungAboveHu = -940.0;  // mean of aerated lung -700..-900, of bowel gas below

struct Coarse {
  CtGrid ct;
  LabelGrid labels;
  MaskGrid body;
  MaskGrid skin_shell;  ///< The first millimetres below the skin.
};

Coarse make_coarse(const CtGrid& ct, const LabelGrid& labels, const FloatGrid& skin_distance_mm) {
  const GridGeometry grid = isotropic_geometry(ct.geometry, kCoarseMm);
  Coarse coarse{resample_linear(ct, grid, -1000), resample_nearest(labels, grid, 0), MaskGrid(grid), MaskGrid(grid)};
  for (std::size_t n = 0; n < coarse.body.voxels.size(); ++n) {
    const float distance_mm = sample_nearest(
        skin_distance_mm,
        grid.to_mm(Eigen::Map<const Eigen::Matrix<std::int64_t, 3, 1>>(grid.index_of(n).data()).cast<double>()), 1.0F);
    coarse.body.voxels[n] = distance_mm < 0.0F ? 1 : 0;
    coarse.skin_shell.voxels[n] = distance_mm < 0.0F && distance_mm > -kSubcutisMm ? 1 : 0;
  }
  return coarse;
}

MaskGrid select(const Coarse& coarse, const auto& is_wanted) {
  MaskGrid mask(coarse.ct.geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) mask.voxels[n] = is_wanted(n) ? 1 : 0;
  return mask;
}

/// Fat that hangs together with the skin, and the skin's own shell.
MaskGrid subcutaneous_fat(const Coarse& coarse) {
  const MaskGrid fat = select(coarse, [&](std::size_t n) {
    return coarse.body.voxels[n] && coarse.labels.voxels[n] == 0 && coarse.ct.voxels[n] > kFatAboveHu &&
           coarse.ct.voxels[n] <= kFatUpToHu;
  });
  MaskGrid sheet = erode(fat, kFatSheetMm);
  for (std::size_t n = 0; n < sheet.voxels.size(); ++n) sheet.voxels[n] |= coarse.skin_shell.voxels[n];
  const Components parts = connected_components(sheet);
  std::vector<bool> at_skin(parts.voxel_counts.size() + 1, false);
  for (std::size_t n = 0; n < sheet.voxels.size(); ++n) {
    if (coarse.skin_shell.voxels[n]) at_skin[static_cast<std::size_t>(parts.ids.voxels[n])] = true;
  }
  return dilate(select(coarse,
                       [&](std::size_t n) {
                         return parts.ids.voxels[n] != 0 && at_skin[static_cast<std::size_t>(parts.ids.voxels[n])];
                       }),
                kFatSheetMm);
}

MaskGrid thick_bone(const Coarse& coarse, const LabelTable& table) {
  std::array<bool, 256> is_bone{};
  for (const Label& label : table.labels) is_bone[label.id] = label.tissue == "bone";
  const MaskGrid bone = select(coarse, [&](std::size_t n) {
    const std::uint8_t id = coarse.labels.voxels[n];
    return is_bone[id] || (id == 0 && coarse.body.voxels[n] && coarse.ct.voxels[n] > kBoneAboveHu);
  });
  return erode(bone, kThickBoneMm);
}

/// Large parts of air inside the body that are not as empty as bowel gas, their vessels included.
MaskGrid aerated_lung(const Coarse& coarse) {
  const MaskGrid air = select(coarse, [&](std::size_t n) {
    return coarse.body.voxels[n] && coarse.labels.voxels[n] == 0 && coarse.ct.voxels[n] < kGasBelowHu;
  });
  const Components parts = connected_components(air);
  std::vector<double> sum_hu(parts.voxel_counts.size() + 1, 0.0);
  for (std::size_t n = 0; n < air.voxels.size(); ++n)
    sum_hu[static_cast<std::size_t>(parts.ids.voxels[n])] += coarse.ct.voxels[n];
  const double voxel_ml = air.geometry.voxel_volume_mm3() / 1000.0;
  const auto is_lung = [&](std::size_t part) {
    if (part == 0) return false;
    const auto voxels = static_cast<double>(parts.voxel_counts[part - 1]);
    return voxels * voxel_ml >= kMinLungMl && sum_hu[part] / voxels > kLungAboveHu;
  };
  const MaskGrid lung =
      select(coarse, [&](std::size_t n) { return is_lung(static_cast<std::size_t>(parts.ids.voxels[n])); });
  return erode(dilate(lung, kLungVesselMm), kLungVesselMm);
}

}  // namespace

LabelGrid find_regions(const CtGrid& smooth_ct, const LabelGrid& labels, const LabelTable& table,
                       const FloatGrid& skin_distance_mm) {
  const Coarse coarse = make_coarse(smooth_ct, labels, skin_distance_mm);
  const MaskGrid near_fat = dilate(subcutaneous_fat(coarse), kWallMm);
  const MaskGrid near_spine = dilate(thick_bone(coarse, table), kSpineReachMm + kThickBoneMm);
  const MaskGrid lung = aerated_lung(coarse);
  LabelGrid regions(coarse.ct.geometry);
  for (std::size_t n = 0; n < regions.voxels.size(); ++n) {
    const Region region = !coarse.body.voxels[n]                       ? Region::kOutside
                          : lung.voxels[n]                             ? Region::kLung
                          : near_fat.voxels[n] || near_spine.voxels[n] ? Region::kWall
                                                                       : Region::kCavity;
    regions.voxels[n] = static_cast<std::uint8_t>(region);
  }
  return regions;
}

}  // namespace trocar::detail
