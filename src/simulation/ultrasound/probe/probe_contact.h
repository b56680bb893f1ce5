#pragma once

#include <span>

#include "geometry/pose.h"
#include "motion/patient_motion.h"
#include "ultrasound/probe/scan_geometry.h"
#include "volume/grid.h"

namespace trocar::ultrasound {

struct AcousticScene;

/// Contact of the face with the skin on one scanline.
struct LineContact {
  float pressed_mm = 0.0F;  ///< Depth of the dent in the skin along the scanline. Range 0..kDeepestDent_mm.
  /// Distance from the skin without contact; gel fills the gap up to its limit. Range 0..kWidestGap_mm.
  float gap_mm = 0.0F;
  float coupling = 1.0F;  ///< Transmitted amplitude, 0..1.
};

inline constexpr double kDeepestDent_mm = 30.0;
inline constexpr double kWidestGap_mm = 8.0;
/// Gel fills gaps up to the first distance and remains in wedges up to the second; air lies beyond. Assumed: gel layers
/// are 1 to 2 mm.
inline constexpr double kGelFills_mm = 1.0;
inline constexpr double kGelEnds_mm = 2.0;

/// Amplitude transmitted through a gap: 1 up to kGelFills_mm, smoothly to 0 at kGelEnds_mm. physics.md U8.
float gap_coupling(float gap_mm) noexcept;

/// Finds the contact of scanlines of a face at X_PT: `contact` is that of `first_line` and the following ones. Searches
/// the skin along the scanline, forwards or backwards, to 0.02 mm. Real-time safe. physics.md U8.
void find_contact(const volume::FloatGrid& skin_distance_mm, const ScanGeometry& geometry, const Pose& X_PT,
                  std::span<LineContact> contact, int first_line = 0,
                  const motion::PatientMotion& motion = {}) noexcept;

/// Default depth below which tissue does not yield. Half of a dent is left at 12 mm, as under a rigid disc as large as
/// the face in B9. Range 12..60.
inline constexpr double kDentReach_mm = 40.0;

// Pressed tissue yields along the scanline (physics.md U8): tissue at `depth_mm` from the face now has its rest
// position at depth_mm - pressed_mm * dent_share(depth_mm). All real-time safe; monotone for every pressed_mm >= 0.

/// Share of the dent that tissue follows: (1 - depth/reach)², from 1 at the face to 0 at the reach and beyond.
inline double dent_share(double depth_mm, double reach_mm = kDentReach_mm) noexcept {
  const double left = depth_mm < reach_mm ? 1.0 - (depth_mm > 0.0 ? depth_mm : 0.0) / reach_mm : 0.0;
  return left * left;
}
/// Resting depth (negative: behind the present position of the face) of tissue displayed at a depth >= 0.
inline double rest_depth_mm(double depth_mm, double pressed_mm, double reach_mm = kDentReach_mm) noexcept {
  return depth_mm - pressed_mm * dent_share(depth_mm, reach_mm);
}
/// Exact inverse of rest_depth_mm(), for resting depths >= -pressed_mm.
double pressed_depth_mm(double rest_depth_mm, double pressed_mm, double reach_mm = kDentReach_mm) noexcept;

/// Reach under a face at X_PT: longer in thick fat, which yields more than the muscle under it, and limited by bone.
/// The value is a mean over the scanlines, so that it changes smoothly with the probe. Real-time safe.
double find_dent_reach_mm(const AcousticScene& scene, const ScanGeometry& geometry, const Pose& X_PT,
                          const motion::PatientMotion& motion = {}) noexcept;

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
