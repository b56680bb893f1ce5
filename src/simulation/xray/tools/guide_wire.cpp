#include "xray/tools/guide_wire.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace trocar::xray {
namespace {

constexpr double kBesideDuct_mm = 1.0;  // the tip may be so far outside of the wall: the bevel is in the duct

/// A way through a cell: towards its b, or towards its a.
struct Leg {
  int cell = -1;
  bool is_forward = true;
};

class WireWalk {
 public:
  explicit WireWalk(const DuctTree& tree) : cells_(tree.cells) {}

  Vec3 end_P(const Leg& leg) const { return leg.is_forward ? at(leg).b_P : at(leg).a_P; }
  Vec3 direction_P(const Leg& leg) const {
    const Vec3 along_P = (at(leg).b_P - at(leg).a_P).normalized();
    return leg.is_forward ? along_P : Vec3(-along_P);
  }

  /// The straightest leg behind another one; empty: the duct ends there or is closed.
  std::optional<Leg> next(const Leg& leg) const {
    std::optional<Leg> best;
    double best_dot = -1.0;
    const auto consider = [&](const Leg& other) {
      const double dot = direction_P(other).dot(direction_P(leg));
      if (best && dot <= best_dot) return;
      best = other;
      best_dot = dot;
    };
    const int joint = leg.is_forward ? leg.cell : at(leg).parent;  // the cell at whose b the legs meet
    if (!leg.is_forward && (joint < 0 || at(leg).is_closed)) return std::nullopt;
    if (!leg.is_forward) consider({joint, false});
    for (std::size_t n = 0; n < cells_.size(); ++n)
      if (cells_[n].parent == joint && static_cast<int>(n) != leg.cell && !cells_[n].is_closed)
        consider({static_cast<int>(n), true});
    return best;
  }

 private:
  const DuctCell& at(const Leg& leg) const { return cells_[static_cast<std::size_t>(leg.cell)]; }
  const std::vector<DuctCell>& cells_;
};

}  // namespace

std::vector<Vec3> guide_wire_way(const DuctTree& tree, const Vec3& tip_P, const Vec3& axis_P, double length_mm) {
  std::vector<Vec3> points_P{tip_P};
  if (!(length_mm > 0.0) || !tip_P.allFinite() || !axis_P.allFinite()) return points_P;
  const int cell = tree.find_cell(tip_P, kBesideDuct_mm);
  if (cell < 0) {
    points_P.push_back(tip_P + std::min(length_mm, kWireInTissue_mm) * axis_P);
    return points_P;
  }
  const WireWalk walk(tree);
  Leg leg{cell, true};
  leg.is_forward = walk.direction_P(leg).dot(axis_P) >= 0.0;
  double left_mm = length_mm;
  for (std::optional<Leg> now = leg; now && left_mm > 0.0; now = walk.next(*now)) {
    const Vec3 step_P = walk.end_P(*now) - points_P.back();
    const double step_mm = step_P.norm();
    if (step_mm > 0.0) points_P.push_back(points_P.back() + std::min(1.0, left_mm / step_mm) * step_P);
    left_mm -= step_mm;
  }
  return points_P;
}

}  // namespace trocar::xray
