#pragma once

#include <cstddef>
#include <cstdint>

#include "geometry/vec.h"

/// The steps of trilinear sampling, a chunk of samples at a time: find the cells, read their voxels, interpolate. The
/// first and the last step are compiled for every instruction set and selected at run time.
namespace trocar::volume::detail {

/// Samples of one chunk. Their intermediate results stay in the first-level cache. The data that one step stores have
/// left the store buffer before the next step reads them in wider loads.
inline constexpr std::size_t kChunk = 128;

/// One axis of the grid as voxel numbers counted from a voxel near the samples, so that a float resolves them to better
/// than 1e-5 of a voxel.
struct AxisLimits {
  float low;   ///< First voxel.
  float top;   ///< Last voxel that begins a cell.
  float high;  ///< Last voxel.
};

/// The grid around the voxel that positions count from.
struct CellGrid {
  const std::int16_t* voxels;  ///< The voxel that positions count from.
  AxisLimits axes[3];
  std::int32_t stride_j;  ///< Voxels to the next row; 0 if the grid has one row.
  std::int32_t stride_k;
};

/// A straight row of positions start + u*step, u = 0, 1, 2 ...
struct RowWalk {
  float start[3];
  float step[3];
};

/// Index (counted from the grid's anchor voxel) = offset + matrix * (point - near_P).
struct PointMap {
  float matrix[3][3];
  float near_P[3];  ///< The anchor voxel's centre, rounded to floats.
  float offset[3];  ///< Offset of near_P from that centre.
};

/// Cells that contain the samples, with their voxels.
struct alignas(64) Cells {
  std::int32_t offset[kChunk];   ///< Offset of the cell's first voxel.
  float fraction[3][kChunk];     ///< Place in the cell, 0..1; [0] is NaN for a point beyond the grid.
  std::int32_t pair[4][kChunk];  ///< Neighbours along i (low half: the lower one) at (j,k) (j+1,k) (j,k+1) (j+1,k+1).
};

/// Cells of the first n positions of a row; positions beyond the outermost voxel centres are clamped to them. Fills
/// whole vectors: a few cells past n are valid as well.
void locate_row(const CellGrid& grid, const RowWalk& row, std::size_t n, Cells& cells) noexcept;

/// Cells of kChunk points; more than half a voxel beyond the outermost voxel centres (or NaN) is outside.
void locate_points(const CellGrid& grid, const PointMap& map, const Vec3f* points_P, Cells& cells) noexcept;

/// Reads the pairs of the first n cells.
void load_pairs(const CellGrid& grid, std::size_t n, Cells& cells) noexcept;

/// Trilinear values of the first n cells; `outside` for points outside of the grid. Writes whole vectors, at most
/// kChunk values.
void interpolate(const Cells& cells, std::size_t n, float outside, float* values) noexcept;

}  // namespace trocar::volume::detail
