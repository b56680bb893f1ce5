#pragma once

#include <vector>

#include "xray/contrast/duct_tree.h"

namespace trocar::xray {

/// A wire that leaves a needle outside of any duct goes straight on for so long and buckles. [assumed]
inline constexpr double kWireInTissue_mm = 5.0;

/// Way of a guide wire beyond a needle's tip, points of P from the tip on: in a duct along the tree's middle lines,
/// first to the side to which the needle points, at each branch the straightest way on, never through a closed place.
/// Its length is `length_mm`, or less where the duct ends. Outside of the ducts at most kWireInTissue_mm straight on.
/// At least one point; `axis_P` is a unit vector.
std::vector<Vec3> guide_wire_way(const DuctTree& tree, const Vec3& tip_P, const Vec3& axis_P, double length_mm);

}  // namespace trocar::xray
