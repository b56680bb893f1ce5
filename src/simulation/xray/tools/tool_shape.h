#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"
#include "motion/patient_motion.h"
#include "xray/contrast/contrast_table.h"
#include "xray/contrast/duct_tree.h"
#include "xray/geometry/c_arm.h"
#include "xray/projection/xray_volume.h"

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

/// A guide wire, catheter or marker of data/xray_tools.toml, without a place.
struct ToolKind {
  std::string name;   ///< "guide-wire"
  std::string title;  ///< For people.
  double outer_diameter_mm = 1.0;
  double inner_diameter_mm = 0.0;
  Basis material = Basis::kSteel;
  double density_g_per_cm3 = 7.9;
};

/// All kinds of the file. Errors name file, line and key: an unknown or missing key, a number out of range, a bore
/// wider than the tool.
Result<std::vector<ToolKind>> load_tool_kinds(const std::filesystem::path& file);
/// Unknown name: exit status 2, the message lists the names.
Result<ToolKind> load_tool_kind(const std::filesystem::path& file, std::string_view name);

/// A tool of that kind along a curve through points of P: a Catmull–Rom spline in pieces of at most 2 mm. One point: a
/// bead, as long as it is thick, along z.
ToolShape tool_along(const ToolKind& kind, std::span<const Vec3> points_P);

/// A wire that leaves a needle outside of any duct goes straight on for so long and buckles. [assumed]
inline constexpr double kWireInTissue_mm = 5.0;

/// Way of a guide wire beyond a needle's tip, points of P from the tip on: in a duct along the tree's middle lines,
/// first to the side to which the needle points, at each branch the straightest way on, never through a closed place.
/// Its length is `length_mm`, or less where the duct ends. Outside of the ducts at most kWireInTissue_mm straight on.
/// At least one point; `axis_P` is a unit vector.
std::vector<Vec3> guide_wire_way(const DuctTree& tree, const Vec3& tip_P, const Vec3& axis_P, double length_mm);

/// Adds the mass of iodine (g/cm²) in ducts and vessels along each ray, averaged over the pixel. Each piece has the
/// mass of its truncated cone; its ends fade into the next piece. Negative concentrations and non-finite pieces are
/// ignored. `rays` are in the frame of the pieces; an empty image is made. All cores.
void add_iodine(const std::vector<IodinePiece>& pieces, const XrayRays& rays, std::vector<float>& iodine_g_per_cm2);

/// Pieces at rest, in frame A, as they are now: their ends move with the tissue, their radii and concentrations change
/// with its stretch so that each keeps its mass.
std::vector<IodinePiece> moved_pieces(std::vector<IodinePiece> pieces, const motion::PatientMotion& motion);

}  // namespace trocar::xray
