#include "haptics/needle_geometry.h"

#include <algorithm>
#include <cmath>

namespace trocar::haptics {
namespace {

/// Axial force on a wedge that spreads the tissue, over that without friction.
double wedge_factor(double bevel_rad, double friction) noexcept {
  const double slope = std::tan(std::min(bevel_rad, kSteepestBevel_rad));
  return (1.0 + friction / slope) / (1.0 - friction * slope);
}

}  // namespace

double needle_size_factor(const anatomy::NeedleSizeLaw& law, double reference_mm,
                          const NeedleGeometry& needle) noexcept {
  if (!(law.diameter_mm > 0.0)) return 1.0;
  const double d = 2.0 * needle.radius_mm / (reference_mm > 0.0 ? reference_mm : law.diameter_mm);
  const double reference_rad = radians(law.bevel_deg);
  const double wedge =
      wedge_factor(needle.bevel_rad, law.face_friction) / wedge_factor(reference_rad, law.face_friction);
  const double sharpness = std::pow(std::sin(needle.bevel_rad) / std::sin(reference_rad), law.bevel_power);
  return (law.tearing * sharpness * d + law.spreading * wedge * d * d) / (law.tearing + law.spreading);
}

}  // namespace trocar::haptics
