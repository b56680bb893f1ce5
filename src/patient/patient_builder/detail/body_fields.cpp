#include "patient_builder/detail/body_fields.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "core/parallel.h"
#include "volume/distance.h"
#include "volume/morphology.h"
#include "volume/resample.h"
#include "volume/sampling.h"

namespace trocar::patient_builder::detail {
namespace {

// Assumed lengths.
constexpr double kCoarseMm = 3.0;
constexpr double kWallReachMm = 25.0;   // abdominal wall or intercostal muscles below the subcutaneous fat
constexpr double kSpineReachMm = 35.0;  // erector spinae and psoas around the spine
constexpr double kThickBoneMm = 8.0;    // radius that fits into a vertebral body or the pelvis, not into a rib
constexpr double kDiscMm = 7.0;         // half the height of the widest disc
constexpr double kFatSheetMm = 5.0;     // radius of what is too thin to be the subcutaneous layer
constexpr double kStepMm = 1.5 * kCoarseMm;
constexpr double kLungVesselMm = 6.0;  // vessels up to this radius belong to the lung
constexpr double kMinLungMl = 20.0;
constexpr double kLungAboveHu = -940.0;  // mean of aerated lung -700..-900, of bowel gas lower

/// Input of the fields, on the coarse grid.
struct Coarse {
  volume::CtGrid ct;
  volume::MaskGrid body;
  volume::MaskGrid unlabelled;  ///< Body without a label.
  volume::MaskGrid skin_shell;  ///< The first millimetres below the skin.
  volume::MaskGrid bone;        ///< Labelled, or dense without a label.
  volume::MaskGrid lung;        ///< Labelled.
};

std::array<bool, 256> ids_of_tissue(const anatomy::LabelTable& table, std::string_view tissue) {
  std::array<bool, 256> ids{};
  for (const anatomy::Label& label : table.labels) ids[label.id] = label.tissue == tissue;
  return ids;
}

Coarse make_coarse(const volume::CtGrid& ct, const volume::LabelGrid& labels, const anatomy::LabelTable& table,
                   const volume::FloatGrid& skin_distance_mm) {
  const volume::GridGeometry grid = volume::isotropic_geometry(ct.geometry, kCoarseMm);
  const volume::MaskGrid none(grid);
  Coarse coarse{volume::resample_linear(ct, grid, -1000), none, none, none, none, none};
  const volume::LabelGrid coarse_labels = volume::resample_nearest(labels, grid, 0);
  const auto is_bone = ids_of_tissue(table, "bone");
  const auto is_lung = ids_of_tissue(table, "lung");
  for (std::size_t n = 0; n < coarse.body.voxels.size(); ++n) {
    const float distance_mm = volume::sample_nearest(skin_distance_mm, grid.centre_mm(grid.index_of(n)), 1.0F);
    const std::uint8_t id = coarse_labels.voxels[n];
    const bool inside = distance_mm < 0.0F;
    coarse.body.voxels[n] = inside;
    coarse.unlabelled.voxels[n] = inside && id == 0;
    coarse.skin_shell.voxels[n] = inside && distance_mm > -kSubcutisMm;
    coarse.bone.voxels[n] = is_bone[id] || (inside && id == 0 && coarse.ct.voxels[n] > kBoneAboveHu);
    coarse.lung.voxels[n] = is_lung[id];
  }
  return coarse;
}

volume::MaskGrid select(const volume::GridGeometry& grid, const auto& is_wanted) {
  volume::MaskGrid mask(grid);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) mask.voxels[n] = is_wanted(n) ? 1 : 0;
  return mask;
}

volume::MaskGrid opened(const volume::MaskGrid& mask, double radius_mm) {
  return volume::dilate(volume::erode(mask, radius_mm), radius_mm);
}
volume::MaskGrid closed(const volume::MaskGrid& mask, double radius_mm) {
  return volume::erode(volume::dilate(mask, radius_mm), radius_mm);
}

/// Fat below the skin: the straight line to the nearest skin contains only fat. (Connectedness would lead around the
/// muscles into the visceral fat.) Thin shadows behind gaps between muscles are removed.
volume::MaskGrid subcutaneous_fat(const Coarse& coarse, const volume::FloatGrid& skin_distance_mm) {
  const volume::GridGeometry& grid = coarse.ct.geometry;
  std::vector<std::pair<float, std::size_t>> by_depth;
  for (std::size_t n = 0; n < coarse.unlabelled.voxels.size(); ++n) {
    const std::int16_t hu = coarse.ct.voxels[n];
    if (coarse.unlabelled.voxels[n] && !coarse.skin_shell.voxels[n] && hu > kFatAboveHu && hu <= kFatUpToHu)
      by_depth.emplace_back(-volume::sample_nearest(skin_distance_mm, grid.centre_mm(grid.index_of(n)), 0.0F), n);
  }
  std::sort(by_depth.begin(), by_depth.end());
  volume::MaskGrid fat = coarse.skin_shell;
  for (const auto& [depth_mm, n] : by_depth) {
    const Vec3 p_P = grid.centre_mm(grid.index_of(n));
    const Vec3 outward_P = volume::gradient_per_mm(skin_distance_mm, p_P).normalized();
    fat.voxels[n] = volume::sample_nearest<std::uint8_t>(fat, p_P + kStepMm * outward_P, 0);
  }
  const volume::MaskGrid core = volume::erode(fat, kFatSheetMm);
  return select(grid, [&](std::size_t n) { return core.voxels[n] || coarse.skin_shell.voxels[n]; });
}

volume::FloatGrid find_wall(const Coarse& coarse, const volume::FloatGrid& skin_distance_mm) {
  // Closed first: some segmentations omit the marrow.
  const volume::MaskGrid spine = opened(closed(coarse.bone, kThickBoneMm), kThickBoneMm);
  const volume::MaskGrid spine_with_discs = closed(spine, kDiscMm);
  const volume::FloatGrid to_spine_mm = volume::distance_to_mask_mm(spine);
  volume::FloatGrid wall = volume::distance_to_mask_mm(subcutaneous_fat(coarse, skin_distance_mm));
  for (std::size_t n = 0; n < wall.voxels.size(); ++n) {
    // The mask of the fat was eroded: its border is farther out by that distance.
    const auto from_fat_mm = static_cast<float>(wall.voxels[n] - kFatSheetMm - kWallReachMm);
    const auto from_spine_mm = static_cast<float>(to_spine_mm.voxels[n] - kSpineReachMm);
    const bool in_spine = spine_with_discs.voxels[n] != 0;  // disc, canal, marrow: not muscle
    wall.voxels[n] = in_spine ? static_cast<float>(kCoarseMm) : std::min(from_fat_mm, from_spine_mm);
  }
  return wall;
}

/// Large parts of air inside the body that are denser than bowel gas, and the labelled lungs.
volume::MaskGrid aerated_lung(const Coarse& coarse) {
  const volume::GridGeometry& grid = coarse.ct.geometry;
  const volume::MaskGrid air = select(grid, [&](std::size_t n) {
    return coarse.lung.voxels[n] || (coarse.unlabelled.voxels[n] && coarse.ct.voxels[n] < kGasBelowHu);
  });
  const volume::Components parts = volume::connected_components(air);
  std::vector<double> sum_hu(parts.voxel_counts.size() + 1, 0.0);
  for (std::size_t n = 0; n < air.voxels.size(); ++n)
    sum_hu[static_cast<std::size_t>(parts.ids.voxels[n])] += coarse.ct.voxels[n];
  const auto is_lung = [&](std::size_t part) {
    if (part == 0) return false;
    const auto voxels = static_cast<double>(parts.voxel_counts[part - 1]);
    return voxels * grid.voxel_volume_mm3() >= 1000.0 * kMinLungMl && sum_hu[part] > kLungAboveHu * voxels;
  };
  return select(grid, [&](std::size_t n) {
    return coarse.lung.voxels[n] || is_lung(static_cast<std::size_t>(parts.ids.voxels[n]));
  });
}

}  // namespace

BodyFields find_body_fields(const volume::CtGrid& smooth_ct, const volume::LabelGrid& labels,
                            const anatomy::LabelTable& table, const volume::FloatGrid& skin_distance_mm) {
  const Coarse coarse = make_coarse(smooth_ct, labels, table, skin_distance_mm);
  return {find_wall(coarse, skin_distance_mm), volume::signed_distance_mm(closed(aerated_lung(coarse), kLungVesselMm))};
}

namespace {

using HuRow = std::span<std::int16_t>;

std::int16_t weighted(int before, int here, int after) {
  return static_cast<std::int16_t>((before + 2 * here + after + 2) >> 2);
}

/// Smooths along a row; the end values continue outside.
void smooth_row(HuRow row) {
  std::int16_t before = row.front();
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::int16_t here = row[i];
    row[i] = weighted(before, here, i + 1 < row.size() ? row[i + 1] : here);
    before = here;
  }
}

/// Smooths across `count` rows, `stride` voxels apart.
void smooth_across(std::int16_t* first, std::size_t length, std::size_t stride, std::size_t count) {
  std::vector<std::int16_t> before(first, first + length);
  for (std::size_t n = 0; n < count; ++n) {
    std::int16_t* row = first + n * stride;
    const std::int16_t* after = n + 1 < count ? row + stride : row;
    for (std::size_t i = 0; i < length; ++i) {
      const std::int16_t here = row[i];
      row[i] = weighted(before[i], here, after[i]);
      before[i] = here;
    }
  }
}

int passes(double spacing_mm) {
  return spacing_mm < 1.2 ? 2 : spacing_mm < 2.5 ? 1 : 0;
}

}  // namespace

volume::CtGrid smooth_hu(const volume::CtGrid& ct) {
  volume::CtGrid smooth = ct;
  const auto columns = static_cast<std::size_t>(ct.geometry.size[0]);
  const auto rows = static_cast<std::size_t>(ct.geometry.size[1]);
  const auto slices = static_cast<std::size_t>(ct.geometry.size[2]);
  const Vec3& spacing_mm = ct.geometry.spacing_mm;
  parallel_for(slices, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      std::int16_t* slice = smooth.voxels.data() + k * rows * columns;
      for (int pass = 0; pass < passes(spacing_mm[0]); ++pass) {
        for (std::size_t j = 0; j < rows; ++j) smooth_row({slice + j * columns, columns});
      }
      for (int pass = 0; pass < passes(spacing_mm[1]); ++pass) smooth_across(slice, columns, columns, rows);
    }
  });
  parallel_for(rows, 8, [&](std::size_t first, std::size_t last) {
    for (std::size_t j = first; j < last; ++j) {
      for (int pass = 0; pass < passes(spacing_mm[2]); ++pass)
        smooth_across(smooth.voxels.data() + j * columns, columns, rows * columns, slices);
    }
  });
  return smooth;
}

}  // namespace trocar::patient_builder::detail
