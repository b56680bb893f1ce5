#pragma once

#include <string>
#include <vector>

#include "geometry/pose.h"
#include "xray/geometry/c_arm.h"
#include "xray/projection/mass_image.h"

namespace trocar::xray {

/// A needle, guide wire, catheter or marker: a tube along its middle line.
struct ToolShape {
  std::string name;
  std::vector<Vec3> line_P;        ///< Points of the middle line, at least two; a marker: two points near each other.
  double outer_radius_mm = 0.5;    ///< Range 0.05..10.
  double inner_radius_mm = 0.0;    ///< 0: solid.
  Basis material = Basis::kSteel;  ///< A catheter's wall is given by its equivalent of steel or iodine.
  double density_g_per_cm3 = 7.9;  ///< Of the wall. Range 0.01..25.
  double filling_iodine_mg_per_ml = 0.0;  ///< Contrast agent inside the bore. Range 0..400.
};

/// Adds the tools' masses along each ray: the exact chord through each piece, averaged over the pixel with
/// weights that fall linearly to the neighbours, so that a thin wire keeps its mass and its place (to 0.1 pixel) at any
/// magnification. The ends are flat. Tools behind the source, not finite or without a radius are left out.
/// docs/physics.md, X7.
void add_tools(const std::vector<ToolShape>& tools, const XrayRays& rays, MassImage& masses);

}  // namespace trocar::xray
