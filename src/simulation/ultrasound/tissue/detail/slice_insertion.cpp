#include "ultrasound/tissue/detail/slice_insertion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace trocar::ultrasound::detail {
namespace {

/// Voxel index with 32 fractional bits: a step along a row is one addition, and its exact range in the grid a division.
using Fixed = std::int64_t;
constexpr int kPlaces = 32;
constexpr double kOne = 4294967296.0;
constexpr GraySum kFull = (kWholePixel * ((GraySum{1} << 20) - 1)) << kWeightShift;
constexpr std::size_t kSlabs = 64;  ///< Enough for several cores if a sweep is concentrated at one end.

std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
  const std::int64_t quotient = a / b;
  return quotient - ((a % b != 0) && ((a < 0) != (b < 0)) ? 1 : 0);
}

/// Narrows first..last to the steps n with low <= start + n * step < high.
void narrow(Fixed start, Fixed step, Fixed low, Fixed high, std::int64_t& first, std::int64_t& last) {
  const Fixed at_first = start + first * step, at_last = start + last * step;
  if (std::min(at_first, at_last) >= low && std::max(at_first, at_last) < high) return;
  if (std::max(at_first, at_last) < low || std::min(at_first, at_last) >= high) {
    last = first - 1;
  } else if (step > 0) {
    first = std::max(first, -floor_divide(start - low, step));
    last = std::min(last, floor_divide(high - 1 - start, step));
  } else {
    first = std::max(first, -floor_divide(high - 1 - start, -step));
    last = std::min(last, floor_divide(start - low, -step));
  }
}

template <FreehandCompounding kCompounding>
void meet(GraySum& cell, GraySum gray, GraySum weight) {
  if constexpr (kCompounding == FreehandCompounding::kMean) {
    if (cell < kFull) cell += (weight << kWeightShift) | (gray * weight);
  } else {
    // A pixel at the centre of eight voxels belongs to all of them, any other to the nearest ones.
    if (weight * 8 < kWholePixel) return;
    const GraySum whole = (kWholePixel << kWeightShift) | (gray * kWholePixel);
    cell = kCompounding == FreehandCompounding::kMaximum ? std::max(cell, whole) : whole;
  }
}

/// Slices first_k..last_k-1 of the volume, filled by one thread.
struct Slab {
  const volume::GridGeometry* grid;
  GraySum* cells;
  std::int64_t first_k, last_k;
  double least_gray;
};

using FixedPoint = std::array<Fixed, 3>;

template <FreehandCompounding kCompounding>
void insert_nearest(const Slab& slab, const std::uint8_t* row, FixedPoint at, const FixedPoint& step,
                    std::int64_t first, std::int64_t last) {
  const auto& size = slab.grid->size;
  for (std::int64_t n = first; n <= last; ++n) {
    const std::int64_t index = ((at[2] >> kPlaces) * size[1] + (at[1] >> kPlaces)) * size[0] + (at[0] >> kPlaces);
    if (row[n] >= slab.least_gray) meet<kCompounding>(slab.cells[index], row[n], kWholePixel);
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] += step[axis];
  }
}

/// Distributes a pixel to the eight voxels around it: `low` is the lower one on all axes, `part` in 256ths towards the
/// next.
template <FreehandCompounding kCompounding>
void share(const Slab& slab, const volume::Index3& low, const std::array<GraySum, 3>& part, GraySum gray) {
  const auto& size = slab.grid->size;
  for (int side = 0; side < 4; ++side) {
    const bool is_next_j = (side & 1) != 0, is_next_k = (side & 2) != 0;
    const std::int64_t j = low[1] + (is_next_j ? 1 : 0), k = low[2] + (is_next_k ? 1 : 0);
    if (k < slab.first_k || k >= slab.last_k || j >= size[1]) continue;
    const GraySum weight = (is_next_j ? part[1] : 256 - part[1]) * (is_next_k ? part[2] : 256 - part[2]);
    constexpr GraySum kHalf = 1 << 15;
    const GraySum weight_low = (weight * (256 - part[0]) + kHalf) >> 16, weight_next = (weight * part[0] + kHalf) >> 16;
    GraySum* cell = slab.cells + (k * size[1] + j) * size[0] + low[0];
    if (weight_low > 0) meet<kCompounding>(cell[0], gray, weight_low);
    if (weight_next > 0 && low[0] + 1 < size[0]) meet<kCompounding>(cell[1], gray, weight_next);
  }
}

template <FreehandCompounding kCompounding>
void insert_linear(const Slab& slab, const std::uint8_t* row, FixedPoint at, const FixedPoint& step, std::int64_t first,
                   std::int64_t last) {
  for (std::int64_t n = first; n <= last; ++n) {
    volume::Index3 low{};
    std::array<GraySum, 3> part{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = at[axis] >> kPlaces;
      part[axis] = static_cast<GraySum>(at[axis] >> (kPlaces - 8)) & 255;
      at[axis] += step[axis];
    }
    if (row[n] >= slab.least_gray) share<kCompounding>(slab, low, part, row[n]);
  }
}

using InsertRow = void (*)(const Slab&, const std::uint8_t*, FixedPoint, const FixedPoint&, std::int64_t, std::int64_t);

InsertRow find_insert(const FreehandOptions& options) {
  using C = FreehandCompounding;
  const bool is_linear = options.interpolation == FreehandInterpolation::kLinear;
  switch (options.compounding) {
    case C::kMaximum:
      return is_linear ? insert_linear<C::kMaximum> : insert_nearest<C::kMaximum>;
    case C::kLatest:
      return is_linear ? insert_linear<C::kLatest> : insert_nearest<C::kLatest>;
    case C::kMean:
      break;
  }
  return is_linear ? insert_linear<C::kMean> : insert_nearest<C::kMean>;
}

/// An image in grid indices, fixed point.
struct FixedFrame {
  const std::uint8_t* picture;
  Vec3 origin, row_step, column_step_voxels;
  FixedPoint column_step;
};

FixedFrame fix(const TrackedSequence& sequence, const PlacedFrame& placed, const volume::GridGeometry& grid,
               double shift) {
  const auto in_voxels = [&](const Vec3& v) -> Vec3 { return v.cwiseQuotient(grid.spacing_mm); };
  FixedFrame fixed;
  fixed.picture = sequence.picture(placed.frame).data();
  fixed.origin = in_voxels(placed.T_PI.col(3).head<3>() - grid.origin_P) + Vec3::Constant(shift);
  fixed.row_step = in_voxels(placed.T_PI.col(1).head<3>());
  fixed.column_step_voxels = in_voxels(placed.T_PI.col(0).head<3>());
  for (int axis = 0; axis < 3; ++axis)
    fixed.column_step[static_cast<std::size_t>(axis)] = std::llround(fixed.column_step_voxels[axis] * kOne);
  return fixed;
}

void insert_into_slab(const Slab& slab, const FixedFrame& frame, const std::vector<PixelRun>& runs, int columns,
                      std::int64_t reach_below, InsertRow insert_row) {
  const auto& size = slab.grid->size;
  for (const PixelRun& run : runs) {
    // From the run's own start: column 0 may be clipped and far outside the grid.
    const Vec3 start = frame.origin + run.row * frame.row_step + run.first * frame.column_step_voxels;
    FixedPoint at{};
    for (int axis = 0; axis < 3; ++axis) at[static_cast<std::size_t>(axis)] = std::llround(start[axis] * kOne);
    std::int64_t first = 0, last = run.last - run.first;
    const Fixed low = std::max<Fixed>(slab.first_k - reach_below, 0);
    narrow(at[2], frame.column_step[2], low << kPlaces, slab.last_k << kPlaces, first, last);
    for (std::size_t axis = 0; axis < 2 && first <= last; ++axis)
      narrow(at[axis], frame.column_step[axis], 0, size[axis] << kPlaces, first, last);
    if (first > last) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] += first * frame.column_step[axis];
    const auto pixel = static_cast<std::ptrdiff_t>(run.row) * columns + run.first;
    insert_row(slab, frame.picture + pixel, at, frame.column_step, first, last);
  }
}

bool is_in_fan(const ClipFan& fan, int column, int row) {
  const double x = column - fan.origin_column, y = row - fan.origin_row;
  const double radius_px = std::hypot(x, y), angle_rad = std::atan2(x, y);
  return radius_px >= fan.first_radius_px && radius_px <= fan.last_radius_px && angle_rad >= fan.first_angle_rad &&
         angle_rad <= fan.last_angle_rad;
}

/// The part of a rectangle in the image; the whole image without one. May be empty.
ClipRectangle inside(const std::optional<ClipRectangle>& rectangle, const TrackedSequence& sequence) {
  if (!rectangle) return {0, 0, sequence.columns, sequence.rows};
  ClipRectangle part;
  part.first_column = std::max(rectangle->first_column, 0);
  part.first_row = std::max(rectangle->first_row, 0);
  part.columns = std::min(sequence.columns, rectangle->first_column + rectangle->columns) - part.first_column;
  part.rows = std::min(sequence.rows, rectangle->first_row + rectangle->rows) - part.first_row;
  return part;
}

/// Maximum of each pixel over all frames.
std::vector<std::uint8_t> brightest_pixels(const TrackedSequence& sequence) {
  std::vector<std::uint8_t> result(sequence.frame_pixels(), 0);
  for (std::size_t frame = 0; frame < sequence.frames.size(); ++frame) {
    const auto picture = sequence.picture(frame);
    for (std::size_t n = 0; n < result.size(); ++n) result[n] = std::max(result[n], picture[n]);
  }
  return result;
}

}  // namespace

std::vector<PixelRun> pixel_runs(const TrackedSequence& sequence, const FreehandOptions& options) {
  const ClipRectangle box = inside(options.rectangle, sequence);
  const std::vector<std::uint8_t> light =
      options.is_black_left_out ? brightest_pixels(sequence) : std::vector<std::uint8_t>{};
  std::vector<PixelRun> runs;
  for (int row = box.first_row; row < box.first_row + box.rows; ++row) {
    bool is_open = false;
    for (int column = box.first_column; column < box.first_column + box.columns; ++column) {
      const auto n =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(sequence.columns) + static_cast<std::size_t>(column);
      const bool counts = (light.empty() || light[n] > 0) && (!options.fan || is_in_fan(*options.fan, column, row));
      if (counts && is_open) runs.back().last = column;
      if (counts && !is_open) runs.push_back({row, column, column});
      is_open = counts;
    }
  }
  return runs;
}

ClipRectangle box_of(const TrackedSequence& sequence, const std::vector<PixelRun>& runs,
                     const FreehandOptions& options) {
  if (options.rectangle) return inside(options.rectangle, sequence);
  int first = runs.front().first, last = runs.front().last;
  for (const PixelRun& run : runs) {
    first = std::min(first, run.first);
    last = std::max(last, run.last);
  }
  return {first, runs.front().row, last - first + 1, runs.back().row - runs.front().row + 1};
}

Extent extent_of(const std::vector<PlacedFrame>& frames, const ClipRectangle& box) {
  Extent extent{Vec3::Constant(std::numeric_limits<double>::infinity()),
                Vec3::Constant(-std::numeric_limits<double>::infinity())};
  for (const PlacedFrame& placed : frames) {
    for (const int row : {box.first_row, box.first_row + box.rows - 1}) {
      for (const int column : {box.first_column, box.first_column + box.columns - 1}) {
        const Vec3 corner = (placed.T_PI * Eigen::Vector4d(column, row, 0.0, 1.0)).head<3>();
        extent.first_P = extent.first_P.cwiseMin(corner);
        extent.last_P = extent.last_P.cwiseMax(corner);
      }
    }
  }
  return extent;
}

void insert_frames(const TrackedSequence& sequence, const std::vector<PlacedFrame>& frames,
                   const std::vector<PixelRun>& runs, const FreehandOptions& options, const volume::GridGeometry& grid,
                   std::vector<GraySum>& cells) {
  const bool is_linear = options.interpolation == FreehandInterpolation::kLinear;
  const double shift = is_linear ? 0.0 : 0.5;
  std::vector<FixedFrame> fixed;
  fixed.reserve(frames.size());
  for (const PlacedFrame& placed : frames) fixed.push_back(fix(sequence, placed, grid, shift));
  // Each thread has its own slices, so that voxels receive their pixels in the order of the frames.
  const auto slices = static_cast<std::size_t>(grid.size[2]);
  const std::size_t slabs = std::min(kSlabs, slices);
  const InsertRow insert_row = find_insert(options);
  parallel_for(slabs, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const Slab slab{&grid, cells.data(), static_cast<std::int64_t>(n * slices / slabs),
                      static_cast<std::int64_t>((n + 1) * slices / slabs), options.least_gray};
      for (const FixedFrame& frame : fixed)
        insert_into_slab(slab, frame, runs, sequence.columns, is_linear ? 1 : 0, insert_row);
    }
  });
}

}  // namespace trocar::ultrasound::detail
