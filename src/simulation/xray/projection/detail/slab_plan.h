#pragma once

#include <array>
#include <optional>
#include <vector>

#include "volume/grid.h"
#include "xray/geometry/c_arm.h"

namespace trocar::xray::detail {

/// Rays in the voxel indices of a grid: pixel (c, r) is hit along direction + c * per_column + r * per_row from the
/// source.
struct IndexRays {
  Vec3 source, direction, per_column, per_row;
  Vec3 spacing_mm;
};
IndexRays index_rays(const XrayRays& rays, const volume::GridGeometry& geometry) noexcept;

/// A part of the detector.
struct DetectorTile {
  int column = 0, row = 0, columns = 0, rows = 0;
};

/// How a tile is projected, in two steps (a factorisation of the perspective, as in shear-warp volume rendering). The
/// volume is a stack of slices across axis n, the index axis along which the rays advance most. First, all slices are
/// summed on a plane parallel to them, on a grid of samples along their own rows and columns: a slice is then only
/// shifted and scaled. Then each pixel of the detector reads the sum where its ray crosses that plane.
struct SlabPlan {
  DetectorTile tile;
  int axis_n = 1, axis_x = 0, axis_y = 2;  ///< Index axes: across the slices, along their rows, and the third one.
  int first_slice = 0, last_slice = 0;     ///< Those on the detector's side of the source.
  double plane = 0.0;                      ///< Index of the plane along axis n.
  double source_x = 0.0, source_y = 0.0, source_n = 0.0;
  double x = 0.0, y = 0.0;            ///< Indices of sample (0, 0).
  double step_x = 1.0, step_y = 1.0;  ///< From sample to sample; at no slice above kLargestStep.
  int columns = 0, rows = 0;          ///< Samples; 0: no ray of the tile meets the volume.
};

/// Largest distance of samples in a slice, in voxels: a vector of four samples must lie within four voxels.
inline constexpr double kLargestStep = 0.65;

/// Plans for all pixels; more than one where the rays of the detector do not all advance along one axis.
std::vector<SlabPlan> plan_slabs(const IndexRays& rays, int columns, int rows, const std::array<std::int64_t, 3>& size);

}  // namespace trocar::xray::detail
