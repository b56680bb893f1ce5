#pragma once

#include "geometry/pose.h"
#include "ultrasound/probe/scan_geometry.h"
#include "volume/grid.h"

namespace trocar::ultrasound {

/// A face that was put onto the skin.
struct FaceFit {
  Pose X_PT;
  double touching = 0.0;  ///< Share of the scanlines with contact.
  double dent_mm = 0.0;   ///< The deepest.
};

inline constexpr double kGreatestFitPress_mm = 15.0;

/// Puts the middle of a face onto a point of the skin: tilted in its plane by at most 15 degrees, so that it lies along
/// the skin (least squares), and pressed in along y by `pressed_mm` and more, up to kGreatestFitPress_mm, until it
/// touches along its width. The plane (x, y of `R_PT`) stays.
FaceFit fit_face(const volume::FloatGrid& skin_distance_mm, const ScanGeometry& scan, const Vec3& skin_P,
                 const Mat3& R_PT, double pressed_mm);

}  // namespace trocar::ultrasound
