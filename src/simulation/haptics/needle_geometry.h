#pragma once

#include "anatomy/tissue/tissue_table.h"

namespace trocar::haptics {

inline constexpr int kMaxBodyProxies = 32;

/// Needle parameters of the force models. Frame N: origin at the tip, +z hub to tip, +y towards the bevel's face.
struct NeedleGeometry {
  double radius_mm = 0.635;               ///< Outer radius. Range 0.1..2.5.
  double length_mm = 150.0;               ///< Stylus origin (grip) to tip. Range 20..300.
  double inner_radius_mm = 0.0;           ///< Radius of the bore; 0: solid. Range 0..0.95 of the radius.
  double stylet_radius_mm = 0.0;          ///< 0: no stylet. At most the bore's radius.
  double young_gpa = 200.0;               ///< Young's modulus of the steel. Range 50..250.
  double bevel_rad = 0.3490658503988659;  ///< Angle between the bevel's face and the axis; 20 degrees. Range 0.05 to
                                          ///< pi/2 (blunt).
  double bevel_share = 0.1;  ///< Sideways force of the bevel as a share of the tip's axial force. Range 0..1.
  int body_proxies = 16;     ///< Range 1..kMaxBodyProxies.
};

/// Force of a needle as a multiple of that of the law's needle with `reference_mm` (0: law.diameter_mm), which is 1
/// (physics.md P7). The bevel's influence is that of kSteepestBevel_rad for steeper ones: a blunt tip punches, which
/// the law does not describe.
double needle_size_factor(const anatomy::NeedleSizeLaw& law, double reference_mm,
                          const NeedleGeometry& needle) noexcept;
inline constexpr double kSteepestBevel_rad = 1.2217;  ///< 70 degrees.

}  // namespace trocar::haptics
