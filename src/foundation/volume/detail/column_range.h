#pragma once

#include "volume/grid.h"

namespace trocar::volume::detail {

/// Columns first..last-1 of a row of samples.
struct ColumnRange {
  int first = 0;
  int last = 0;
};

/// True where a fractional index lies inside the grid's box: less than half a voxel beyond the outermost voxel centres.
/// NaN is outside. The same rule as sample_nearest.
bool is_inside(const GridGeometry& geometry, const Vec3& index) noexcept;

/// The columns u of 0..columns-1 whose index start + u*step lies inside the grid's box. They are consecutive, so a row
/// needs no test per sample. Empty if start or step is not finite.
ColumnRange columns_inside(const GridGeometry& geometry, const Vec3& start, const Vec3& step, int columns) noexcept;

}  // namespace trocar::volume::detail
