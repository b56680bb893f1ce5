#pragma once

#include "anatomy/label_table.h"
#include "volume/grid.h"

namespace trocar::detail {

/// Where inside the body a voxel lies, as far as CT values alone do not tell. On a coarse grid (3 mm).
enum class Region : std::uint8_t {
  kOutside = 0,
  kWall =
      1,  ///< Trunk wall: within reach of the subcutaneous fat or of the spine and pelvis, so lean tissue is muscle.
  kCavity = 2,  ///< Deeper: lean tissue may be bowel, mesentery, an organ without a label.
  kLung = 3,    ///< Aerated lung that no label covers.
};

/// Finds the regions from the smoothed CT, the labels known so far and the signed distance to the skin.
LabelGrid find_regions(const CtGrid& smooth_ct, const LabelGrid& labels, const LabelTable& table,
                       const FloatGrid& skin_distance_mm);

}  // namespace trocar::detail
