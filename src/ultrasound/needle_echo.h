#pragma once

#include <span>

#include "geometry/vec.h"

namespace trocar {

/// A needle as sound meets it. Frame P, mm.
struct NeedleEcho {
  std::span<const Vec3> shaft_P;  ///< Polyline from the hub to the tip; bent needles have more than two points.
  double diameter_mm = 1.2;       ///< Range 0.2..5.
  double tip_mm = 3.0;            ///< Length of the roughened or bevelled tip, which echoes to all sides.
  double displacement_mm = 0.0;   ///< How far tissue at the tip is dragged along the axis. Range -10..10.
};

}  // namespace trocar
