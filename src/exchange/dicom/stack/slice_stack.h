#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "geometry/vec.h"
#include "volume/grid.h"

namespace trocar::dicom {

inline constexpr double kFarthest_mm = 1e5;  ///< Largest coordinate in a file: no scanner is larger than 100 m.

/// Parallel slices of one size, at the places that their files state. Frame P, mm.
struct SliceStack {
  Vec3 row_P = Vec3::UnitX();     ///< Along a row (growing column); unit vector.
  Vec3 column_P = Vec3::UnitY();  ///< Along a column; unit vector at a right angle to row_P.
  double column_step_mm = 1.0;    ///< Between columns.
  double row_step_mm = 1.0;       ///< Between rows.
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  std::vector<Vec3> origins_P;  ///< Centre of the first pixel of each slice, ascending along row x column.

  Vec3 normal_P() const noexcept { return row_P.cross(column_P).normalized(); }
  double along_mm(std::size_t slice) const noexcept { return normal_P().dot(origins_P[slice]); }
};

/// Source of one plane of a grid: two neighbouring slices and the weight 0..1 of the upper one.
struct StackLayer {
  std::size_t below = 0;
  std::size_t above = 0;
  double weight_above = 0.0;
};

/// How the slices of a stack fill a grid with right angles and even steps.
struct StackPlan {
  volume::GridGeometry geometry;  ///< i along rows, j along columns, k along the normal.
  bool is_plain = true;           ///< Plane k of the grid is slice k, unchanged.
  bool is_uneven = false;         ///< The distances of the slices differ.
  double tilt_deg = 0.0;          ///< Angle between the stack and the normal of its slices (gantry tilt).
  double shift_mm = 0.0;          ///< Largest sideways shift of a slice, where the stack is tilted.
  std::vector<StackLayer> layers;
  std::vector<Eigen::Vector2d> offsets_px;  ///< For each slice: where its first pixel lies in the grid (i, j).
};

/// The widest gap of a stack, and the usual distance of its slices (median).
struct StackGap {
  std::size_t below = 0;  ///< The gap is between this slice and the next.
  double gap_mm = 0.0;
  double median_mm = 0.0;
};
StackGap widest_gap(const SliceStack& stack);
/// Angle in degrees between the stack, from its first to its last slice, and the normal of its slices.
double tilt_deg(const SliceStack& stack);
/// True if the distances differ by more than 5 % of their mean and 0.06 mm (positions may be rounded).
bool is_uneven(const SliceStack& stack);
/// True for numbers that a scanner can have: places within 100 m, pixels of 1 um to 1 m. To be checked before a plan.
bool is_sane(const SliceStack& stack);

/// An uneven stack gets the smallest distance of two slices as its step, but at least half of the usual one; a stack
/// that leans by more than 0.3 degrees becomes straight. `stack` is sane and has at least one slice, in order, no two
/// at one place; `single_step_mm` > 0 is the step of a single one. The geometry is as exact as the file: the directions
/// may be skewed by rounding. Empty if the stack leans by more than 45 degrees, or has so wide a gap that its grid
/// would need more than 16 planes for each slice.
std::optional<StackPlan> plan_stack(const SliceStack& stack, double single_step_mm = 1.0);

/// Fills the plan's grid from the slices (i fastest, then j, then slice; `slices` has all their pixels). Numbers are
/// interpolated linearly, labels (bytes) take the nearest slice and pixel; beyond the slices the value is `outside`.
template <class T>
volume::Grid<T> fill_from_stack(const StackPlan& plan, const SliceStack& stack, std::vector<T> slices, T outside);

}  // namespace trocar::dicom
