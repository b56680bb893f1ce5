#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ultrasound/engine/detail/scatterer_cell.h"

/// Scatterers fill P in cubes, "bricks". What a brick holds is a pure function of its place in P, so that speckle moves
/// with the tissue; it is one of a library's, turned and mirrored.
namespace trocar::ultrasound::detail {

inline constexpr int kBrickScatterers = 32;
/// All are equally strong, of either sign, and stratified in their brick: with that a few in a resolution cell are
/// enough for fully developed speckle (free places and amplitudes need four times as many).
inline constexpr double kMeanSquareScatterer = 1.0;
inline constexpr int kBricks = 256;  ///< Of the library.

/// Scatterers of one brick: place in the brick, -0.5..0.5 of its side, and its rank: the share of scatterers at which
/// it is one of those that are there, with the sign of its amplitude.
struct alignas(64) Brick {
  std::array<float, kBrickScatterers> x, y, z, rank;
};
std::vector<Brick> make_brick_library();

/// A brick as it lies in T: middle + x * scatterer.x + y * scatterer.y + z * scatterer.z.
struct PlacedBrick {
  float middle[3], x[3], y[3], z[3];
  const Brick* brick;
};
/// The brick of that place in the lattice: which of the library, its axes exchanged and mirrored. `side_T`: the sides
/// of a brick, columns, in T.
PlacedBrick place_brick(const BrickIndex& index, const std::vector<Brick>& library, const Vec3f& middle_T,
                        const Eigen::Matrix3f& side_T) noexcept;

}  // namespace trocar::ultrasound::detail
