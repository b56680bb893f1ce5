#pragma once

#include <array>
#include <vector>

#include "volume/grid.h"

namespace trocar::motion_builder::detail {

inline constexpr std::size_t kRegions = 2;  ///< 0: the wall, 1: inside of it.

/// What the displacements of both regions have to be, on the nodes of a lattice.
struct DisplacementProblem {
  volume::GridGeometry lattice;
  struct Node {
    float stiffness = 0.0F;  ///< Resistance to a gradient of displacement.
    float pull = 0.0F;       ///< Strength with which the node is drawn to `target_mm`.
    Vec3f target_mm = Vec3f::Zero();
    float bulk = 0.0F;  ///< Resistance to a change of volume.
  };
  std::array<std::vector<Node>, kRegions> nodes;
  struct Border {
    float strength = 0.0F;  ///< Of the condition that the regions neither part nor overlap; 0: not at the border.
    Vec3f normal = Vec3f::Zero();
  };
  std::vector<Border> border;
};

using Displacements = std::array<std::vector<Vec3f>, kRegions>;

/// The displacements (mm) of least energy: sum of stiffness * |difference of neighbours|^2 + pull * |u - target|^2 +
/// bulk * (spacing * divergence)^2 over nodes, edges and cells, and strength * (normal . (u_wall - u_inside))^2 at the
/// border: an elastic body whose two parts slide along each other. By conjugate gradients from `start` (empty: zero),
/// until the residual is `tolerance` of the first one or `most_steps` are done. One thread.
Displacements solve(const DisplacementProblem& problem, const Displacements& start, int most_steps,
                    double tolerance = 1e-3);

}  // namespace trocar::motion_builder::detail
