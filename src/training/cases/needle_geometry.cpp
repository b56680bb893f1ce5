#include "cases/needle_geometry.h"

#include <numbers>

namespace trocar::cases {

haptics::NeedleGeometry needle_geometry(const tasks::Needle& needle) noexcept {
  haptics::NeedleGeometry geometry;
  geometry.radius_mm = 0.5 * needle.outer_diameter_mm;
  geometry.length_mm = needle.length_mm;
  geometry.inner_radius_mm = 0.5 * needle.inner_diameter_mm;
  geometry.stylet_radius_mm = 0.5 * needle.stylet_diameter_mm;
  geometry.bevel_rad = needle.bevel_deg * std::numbers::pi / 180.0;
  geometry.bevel_share = needle.bevel_share;
  return geometry;
}

}  // namespace trocar::cases
