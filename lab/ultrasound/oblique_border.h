#pragma once

#include <vector>

#include "lab/ultrasound/speckle_statistics.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound {

/// The brightest border on one scanline of a picture.
struct ObliqueBorder {
  double above_gray = 0.0;     ///< Above the mean of the 15 mm in front of it.
  double thickness_mm = 0.0;   ///< Across the border, at half of that.
  double incidence_rad = 0.0;  ///< Between the scanline and its normal.
};

/// Borders of a picture in scanline coordinates: on each scanline the brightest place deeper than 60 mm, if it
/// continues on neighbouring scanlines and is at least 30 gray values brighter than what is in front of it.
std::vector<ObliqueBorder> find_oblique_borders(const EchoPatch& polar, const ScanGeometry& scan);

}  // namespace trocar::ultrasound
