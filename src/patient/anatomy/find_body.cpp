#include <algorithm>

#include "anatomy/build_patient.h"
#include "core/check.h"
#include "core/parallel.h"
#include "volume/morphology.h"
#include "volume/orientation.h"
#include "volume/resample.h"

namespace trocar::anatomy {
namespace {

// All numbers are assumed: chosen on two CTs (3 mm and 0.74 mm voxels), with a safety distance.
constexpr std::int16_t kSolidAboveHu = -300;  // skin and fat above, air, foam and cloth below
constexpr double kTableVoxelMm = 3.0;         // the table is found at this resolution
constexpr double kThinRadiusMm = 5.0;         // plates, tubes and blankets are thinner than twice this
constexpr double kLongMm = 120.0;             // thin parts that are longer do not belong to a body
constexpr double kSealRadiusMm = 7.0;         // gaps in the chest wall from removing the table
constexpr double kContourSearchMm = 4.0;      // search distance of the fine contour around the coarse one

volume::MaskGrid solid_of(const volume::CtGrid& ct) {
  volume::MaskGrid mask(ct.geometry);
  parallel_for(mask.voxels.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) mask.voxels[n] = ct.voxels[n] > kSolidAboveHu ? 1 : 0;
  });
  return mask;
}

/// a and not b.
volume::MaskGrid without(volume::MaskGrid a, const volume::MaskGrid& b) {
  for (std::size_t n = 0; n < a.voxels.size(); ++n) a.voxels[n] = a.voxels[n] && !b.voxels[n] ? 1 : 0;
  return a;
}

volume::MaskGrid opened(const volume::MaskGrid& mask, double radius_mm) {
  return volume::dilate(volume::erode(mask, radius_mm), radius_mm);
}

/// Thin connected parts of a mask with a long box: the CT table, tubes, folds of a blanket.
volume::MaskGrid long_thin_parts(const volume::MaskGrid& solid) {
  const volume::GridGeometry& geometry = solid.geometry;
  const volume::Components parts = volume::connected_components(without(solid, opened(solid, kThinRadiusMm)));
  struct Box {
    volume::Index3 low, high;
  };
  std::vector<Box> boxes(parts.voxel_counts.size(), Box{geometry.size, {-1, -1, -1}});
  for (std::size_t n = 0; n < parts.ids.voxels.size(); ++n) {
    if (parts.ids.voxels[n] == 0) continue;
    Box& box = boxes[static_cast<std::size_t>(parts.ids.voxels[n] - 1)];
    const volume::Index3 ijk = geometry.index_of(n);
    for (std::size_t a = 0; a < 3; ++a) {
      box.low[a] = std::min(box.low[a], ijk[a]);
      box.high[a] = std::max(box.high[a], ijk[a]);
    }
  }
  volume::MaskGrid mask(geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) {
    if (parts.ids.voxels[n] == 0) continue;
    const Box& box = boxes[static_cast<std::size_t>(parts.ids.voxels[n] - 1)];
    double extent_mm = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
      extent_mm = std::max(extent_mm, static_cast<double>(box.high[a] - box.low[a] + 1) *
                                          geometry.spacing_mm[static_cast<Eigen::Index>(a)]);
    mask.voxels[n] = extent_mm > kLongMm ? 1 : 0;
  }
  return mask;
}

/// Fills the body's lungs and bowel gas; seals a torn chest wall for this, but keeps outer folds open.
volume::MaskGrid filled(const volume::MaskGrid& body) {
  const volume::MaskGrid sealed = volume::dilate(body, kSealRadiusMm);
  const volume::MaskGrid cavities =
      volume::dilate(without(volume::fill_holes_in_slices(sealed), sealed), kSealRadiusMm);
  volume::MaskGrid whole = body;
  for (std::size_t n = 0; n < whole.voxels.size(); ++n) whole.voxels[n] |= cavities.voxels[n];
  return volume::fill_holes(volume::fill_holes_in_slices(whole));
}

volume::MaskGrid find_coarse_body(const volume::CtGrid& ct) {
  const volume::MaskGrid solid = solid_of(ct);
  const volume::MaskGrid body = volume::largest_component(without(solid, long_thin_parts(solid)));
  return volume::largest_component(opened(filled(body), kThinRadiusMm));
}

}  // namespace

volume::MaskGrid find_body(const volume::CtGrid& ct) {
  TROCAR_CHECK(volume::order_along_P(ct.geometry).is_identity());
  const volume::CtGrid coarse_ct =
      volume::resample_linear(ct, volume::isotropic_geometry(ct.geometry, kTableVoxelMm), -1000);
  volume::MaskGrid zones = find_coarse_body(coarse_ct);
  {  // 0: far from the body, 1: the fine contour decides, 2: deep inside
    const volume::MaskGrid near = volume::dilate(zones, kContourSearchMm);
    const volume::MaskGrid deep = volume::erode(zones, kContourSearchMm);
    for (std::size_t n = 0; n < zones.voxels.size(); ++n) zones.voxels[n] = deep.voxels[n] ? 2 : near.voxels[n];
  }
  volume::MaskGrid body = volume::resample_nearest(zones, ct.geometry, 0);
  parallel_for(body.voxels.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      std::uint8_t& voxel = body.voxels[n];
      voxel = voxel == 2 || (voxel == 1 && ct.voxels[n] > kSolidAboveHu) ? 1 : 0;
    }
  });
  return volume::largest_component(volume::fill_holes_in_slices(body));
}

}  // namespace trocar::anatomy
