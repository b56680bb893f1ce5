#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ultrasound/engine/detail/scatterer_cell.h"

/// Scatterers fill P in cubes ("bricks"). The content of a brick is a pure function of its position in P, so that
/// speckle moves with the tissue. A brick is an element of a library, rotated and mirrored.
namespace trocar::ultrasound::detail {

inline constexpr int kBrickScatterers = 32;
/// All scatterers have the same strength, of either sign, and are stratified in their brick. A few in a resolution cell
/// then suffice for fully developed speckle (random positions and amplitudes need four times as many).
inline constexpr double kMeanSquareScatterer = 1.0;
inline constexpr int kBricks = 256;  ///< Size of the library.

/// Scatterers of one brick: position in the brick, -0.5..0.5 of its side, and rank. The rank is the share of scatterers
/// from which on the scatterer is present, with the sign of its amplitude.
struct alignas(64) Brick {
  std::array<float, kBrickScatterers> x, y, z, rank;
};
std::vector<Brick> make_brick_library();

/// A brick placed in T: middle + x * scatterer.x + y * scatterer.y + z * scatterer.z.
struct PlacedBrick {
  float middle[3], x[3], y[3], z[3];
  const Brick* brick;
};
/// Places the brick at `index` of the lattice: selects an element of the library, with its axes exchanged and mirrored.
/// `side_T`: the sides of a brick, columns, in T.
PlacedBrick place_brick(const BrickIndex& index, const std::vector<Brick>& library, const Vec3f& middle_T,
                        const Eigen::Matrix3f& side_T) noexcept;

}  // namespace trocar::ultrasound::detail
