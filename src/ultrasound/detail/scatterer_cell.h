#pragma once

#include <array>
#include <cstdint>

#include "ultrasound/detail/frame_state.h"
#include "ultrasound/detail/scan_plan.h"

/// Where a task looks for scatterers: some scanlines, some depth.
namespace trocar::detail {

/// The scanlines and resting depths that a task looks for scatterers in, with bounds that are cheap to test in T: half
/// planes on either side (x * nx + (y + radius) * ny <= 0), squared distance from the apex (fans) or y, thickness.
struct Cell {
  int first_line, last_line;
  double low_line, high_line;  ///< Straight scanlines between which lies what the bent ones hear.
  float first_rest, last_rest;
  float side_x[2], side_y[2], side_d[2];
  float low, high;
  float half_thickness_mm;
  float most_rank;
  /// What varies slowly with depth, as a line through its values at the cell's ends: [0] + [1] * sample.
  float speckle_scale[2], rank[2];
};
Cell make_cell(const ScanPlan& plan, const FrameState& frame, int first, int last, float first_rest,
               float last_rest) noexcept;

using BrickIndex = std::array<std::int32_t, 3>;  ///< Of a cube of P.

/// The box in P around a cell, in bricks.
struct CellBox {
  BrickIndex low, high;
};
CellBox box_of(const ScanPlan& plan, const FrameState& frame, const Cell& cell) noexcept;

/// Narrows first..last to the steps of a row, z = start + step * n, that stay within the beam's thickness.
void stay_in_beam(float start, float step, float half_mm, int& first, int& last) noexcept;
/// Whether a brick of that middle, a ball about it, can hold a scatterer of the cell.
bool comes_near(const ScanPlan& plan, const Cell& cell, const Vec3f& middle_T, float radius_mm) noexcept;

}  // namespace trocar::detail
