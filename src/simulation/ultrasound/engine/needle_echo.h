#pragma once

#include <span>

#include "geometry/vec.h"

namespace trocar::ultrasound {

/// Acoustic model of a needle. Frame P, mm. A needle with non-finite values, or shorter than its point, has no echo.
struct NeedleEcho {
  std::span<const Vec3> shaft_P;  ///< Polyline from the hub to the tip; bent needles have more than two points.
  double diameter_mm = 1.2;       ///< Range 0.2..5.
  double tip_mm = 3.0;  ///< Length of the roughened or bevelled tip, which reflects in all directions. Range 0..30.
  double displacement_mm = 0.0;  ///< Displacement of tissue at the tip along the axis. Range -10..10.
  /// Diameter of the bore, filled with fluid, divided by the outer diameter; 0 with the stylet in. Range 0..0.9. 18 G,
  /// regular wall: 0.84 of 1.27 mm (ISO 9626).
  double bore_share = 0.66;
};

}  // namespace trocar::ultrasound
