#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Region of a task's scatterers: some scanlines, some depth.
namespace trocar::ultrasound::detail {

/// Scanlines and resting depths of a task's bricks, with bounds that are cheap to test in T: half planes on either side
/// (x * nx + (y + radius) * ny <= 0), squared distance from the apex (fans) or y, thickness. A brick belongs to the
/// cell that contains the depth of its middle; its scatterers may lie outside, by `reach`.
struct Cell {
  int first_line, last_line;
  double low_line, high_line;  ///< Straight scanlines that bound the regions of all bent ones.
  float near_rest, far_rest;   ///< Depths of its scatterers, samples.
  float side_x[2], side_y[2], side_d[2];
  float low, high;  ///< Of the middles of its bricks.
  float half_thickness_mm;
  float most_rank;
  bool yields;  ///< Part of its tissue is displaced by a dented face.
  /// Slowly varying functions of depth, as parabolas: [0] + [1] * sample + [2] * sample^2.
  float speckle_scale[3], rank[3], inverse_elevation_sigma[3];
};
/// The cell of bricks with their middles between two depths (samples), whose scatterers are at most `reach` samples
/// away.
Cell make_cell(const ScanPlan& plan, const FrameState& frame, int first, int last, float first_rest, float last_rest,
               float reach) noexcept;

using BrickIndex = std::array<std::int32_t, 3>;  ///< Index of a cube of P.

/// The box in P around a cell, in bricks.
struct CellBox {
  BrickIndex low, high;
};
CellBox box_of(const ScanPlan& plan, const FrameState& frame, const Cell& cell) noexcept;

/// Where the patient moves: the tissue of a cell at rest, by its middle and the map's slope there, and how far tissue
/// of the cell is from that.
struct CellAtRest {
  CellBox box;
  Vec3 middle_A, middle_P;
  Mat3 jacobian;
  double slack_mm = 0.0;

  Vec3 now_P(const Vec3& p_A) const noexcept { return middle_P + jacobian * (p_A - middle_A); }
};
CellAtRest rest_of(const ScanPlan& plan, const FrameState& frame, const Cell& cell) noexcept;

/// How far the tissue of a brick reaches from its middle, mm: across the image, and across the cell's sides.
struct BrickReach {
  float across_mm;
  float side_mm[2];
};
/// `side_T`: the sides of a brick, columns; `more_mm`: displacement of the tissue by a needle.
BrickReach reach_of(const Cell& cell, const Eigen::Matrix3f& side_T, float more_mm) noexcept;

/// Narrows first..last to those bricks of a row that intersect the cell's sides and the beam's thickness. Their middles
/// are start_T + step_T * n.
void stay_in_cell(const ScanPlan& plan, const Cell& cell, const BrickReach& reach, const Vec3f& start_T,
                  const Vec3f& step_T, int& first, int& last) noexcept;

/// True if a brick with that middle belongs to the cell's depths. `radius_mm`: of the face of a fan.
inline bool is_at_depth(const Cell& cell, bool is_fan, float radius_mm, const Vec3f& middle_T) noexcept {
  const float y = middle_T.y() + (is_fan ? radius_mm : 0.0F);
  const float far = is_fan ? middle_T.x() * middle_T.x() + y * y : y;
  return far >= cell.low && far < cell.high;
}

}  // namespace trocar::ultrasound::detail

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
