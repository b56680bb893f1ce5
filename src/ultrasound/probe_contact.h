#pragma once

#include <cmath>
#include <span>

#include "geometry/pose.h"
#include "ultrasound/scan_geometry.h"
#include "volume/grid.h"

namespace trocar {

/// How the face meets the skin on one scanline.
struct LineContact {
  float pressed_mm = 0.0F;  ///< The face dents the skin so deep, along the scanline.
  float gap_mm = 0.0F;      ///< Or stays off it.
  float coupling = 1.0F;    ///< Amplitude that passes, 0..1.
};

/// Share of the dent that tissue follows which lies `depth_mm` before the face: 1 at the face, falling.
inline double dent_share(double depth_mm) noexcept {
  return std::exp(-depth_mm / 30.0);
}

/// Contact of every scanline.
inline void find_contact(const FloatGrid& /*skin_distance_mm*/, const ScanGeometry& /*geometry*/, const Pose& /*X_PT*/,
                         std::span<LineContact> contact) noexcept {
  for (LineContact& line : contact) line = {};
}

}  // namespace trocar
