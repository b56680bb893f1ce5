#pragma once

#include <array>
#include <vector>

#include "xray/projection/detail/row_stack.h"
#include "xray/projection/detail/slab_plan.h"

namespace trocar::xray::detail {

/// Sums on a plan's plane: plan.rows rows of `stride` samples, of which plan.columns are in use, by channel (water and
/// bone, or one).
struct SlabSums {
  std::size_t stride = 0;
  std::array<std::vector<float>, 2> channels;
};

inline constexpr std::size_t kSamplePadding = 16;  ///< Samples beyond a row of sums that a vector may write.

/// Directions of a row of pixels along axes x, y, n, and the samples of the plane.
struct PixelRow {
  std::array<std::array<float, 2>, 3> direction{};  ///< At the row's first pixel, and from pixel to pixel.
  std::array<float, 3> spacing_mm{};
  std::array<float, 2> origin{}, per_slope{};  ///< Sample = origin + per_slope * slope of the ray.
  int columns = 0, rows = 0, stride = 0;       ///< Of the samples.
};

/// Adds all slices to rows [first, last) of the sums, which are zero. SIMD.
void sum_slices(const RowsView<PackedVoxel>& view, const SlabPlan& plan, int first, int last, SlabSums& sums);
void sum_slices(const RowsView<float>& view, const SlabPlan& plan, int first, int last, SlabSums& sums);

/// Writes rows [first, last) of the plan's tile into an image of `image_columns` pixels a row: the sum where the
/// pixel's ray crosses the plane, times the ray's length in a slice (mm) and `factor`. SIMD.
void read_sums(const SlabSums& sums, int channel, const SlabPlan& plan, const IndexRays& rays, float factor, int first,
               int last, int image_columns, float* image);

}  // namespace trocar::xray::detail
