#pragma once

#include <functional>
#include <vector>

#include "anatomy/phantom/shapes.h"

namespace trocar::anatomy::phantom {

/// Growth parameters of a vessel tree.
struct GrowthRule {
  float root_radius_mm = 7.0F;
  float root_share = 0.5F;       ///< Fraction of the distance to the territory's centre at which the root forks.
  float least_radius_mm = 1.2F;  ///< Thinner branches are not grown.
  /// True if a vessel of this radius may run through a point of P.
  std::function<bool(const Vec3f& p, float radius_mm)> allowed;
};

struct VesselRoot {
  Vec3f p;
  Vec3f direction;
};

/// Grows a tree by halving the territory it supplies: a vessel grows towards the centre of its territory and forks
/// there; each daughter supplies one half. Radii follow Murray's law, r^3 = r1^3 + r2^3 (C. D. Murray, PNAS 12:207,
/// 1926), with each daughter's r^3 proportional to its share of the territory. A vessel that violates a constraint
/// tries other bends and lengths, and forks at once if none fits.
std::vector<Cone> grow_tree(const VesselRoot& root, std::vector<Vec3f> territory, const GrowthRule& rule,
                            Random& random);

}  // namespace trocar::anatomy::phantom
