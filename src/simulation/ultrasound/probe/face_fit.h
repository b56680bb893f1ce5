#pragma once

#include "geometry/pose.h"
#include "ultrasound/probe/scan_geometry.h"
#include "volume/grid.h"

namespace trocar::ultrasound {

/// Result of placing a face on the skin.
struct FaceFit {
  Pose X_PT;
  double touching = 0.0;  ///< Share of the scanlines with contact.
  double dent_mm = 0.0;   ///< Deepest dent.
};

inline constexpr double kGreatestFitPress_mm = 15.0;

/// Places the middle of a face on a point of the skin. Tilts the face in its plane by at most 15 degrees to align it
/// with the skin (least squares). Presses it in along y by `pressed_mm` or more, up to kGreatestFitPress_mm, until it
/// touches along its width. The plane (x, y of `R_PT`) does not change.
FaceFit fit_face(const volume::FloatGrid& skin_distance_mm, const ScanGeometry& scan, const Vec3& skin_P,
                 const Mat3& R_PT, double pressed_mm);

}  // namespace trocar::ultrasound
