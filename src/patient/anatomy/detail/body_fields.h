#pragma once

#include "anatomy/label_table.h"
#include "volume/grid.h"

namespace trocar::anatomy::detail {

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
BodyFields find_body_fields(const volume::CtGrid& smooth_ct, const volume::LabelGrid& labels, const LabelTable& table,
                            const volume::FloatGrid& skin_distance_mm);

}  // namespace trocar::anatomy::detail
