#pragma once

#include <array>
#include <cstdint>

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Region of a task's scatterers: some scanlines, some depth.
namespace trocar::ultrasound::detail {

/// Scanlines and resting depths of a task's scatterers, with bounds that are cheap to test in T: half planes on either
/// side (x * nx + (y + radius) * ny <= 0), squared distance from the apex (fans) or y, thickness.
struct Cell {
  int first_line, last_line;
  double low_line, high_line;  ///< Straight scanlines that bound the regions of all bent ones.
  float first_rest, last_rest;
  float side_x[2], side_y[2], side_d[2];
  float low, high;
  float near_mm, far_mm;  ///< `low` and `high`, not squared.
  float half_thickness_mm;
  float most_rank;
  bool yields;  ///< Part of its tissue is displaced by a dented face.
  /// Slowly varying functions of depth, as parabolas: [0] + [1] * sample + [2] * sample^2.
  float speckle_scale[3], rank[3], inverse_elevation_sigma[3];
};
Cell make_cell(const ScanPlan& plan, const FrameState& frame, int first, int last, float first_rest,
               float last_rest) noexcept;

using BrickIndex = std::array<std::int32_t, 3>;  ///< Index of a cube of P.

/// The box in P around a cell, in bricks.
struct CellBox {
  BrickIndex low, high;
};
CellBox box_of(const ScanPlan& plan, const FrameState& frame, const Cell& cell) noexcept;

/// Narrows first..last to those bricks of a row that intersect the cell's sides and the beam's thickness. The bricks
/// are balls about start_T + step_T * n.
void stay_in_cell(const ScanPlan& plan, const Cell& cell, const Vec3f& start_T, const Vec3f& step_T, float radius_mm,
                  int& first, int& last) noexcept;
/// True if such a ball intersects the cell's depths.
bool is_at_depth(const ScanPlan& plan, const Cell& cell, const Vec3f& middle_T, float radius_mm) noexcept;

}  // namespace trocar::ultrasound::detail
