#include "volume/detail/sampling_kernels.h"

#include <bit>
#include <cstring>
#include <limits>

// Compiled for each instruction set by foreach_target.h; selected at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/detail/sampling_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that this header compiles for.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trocar::volume::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::ScalableTag<float>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;

/// Splits positions into the cell's first voxel (returned) and the position in the cell.
HWY_INLINE VI split(VF position, const AxisLimits& axis, VF& fraction) {
  const F f;
  const VF clamped = hn::Min(hn::Max(position, hn::Set(f, axis.low)), hn::Set(f, axis.high));
  const VF cell = hn::Min(hn::Floor(clamped), hn::Set(f, axis.top));
  fraction = hn::Sub(clamped, cell);
  return hn::ConvertTo(I(), cell);
}

HWY_INLINE VI offset_of(const CellGrid& grid, VI i, VI j, VI k) {
  const I d;
  return hn::Add(i, hn::Add(hn::Mul(j, hn::Set(d, grid.stride_j)), hn::Mul(k, hn::Set(d, grid.stride_k))));
}

void locate_row(const CellGrid& grid, const RowWalk& row, std::size_t n, Cells& cells) {
  const F f;
  for (std::size_t s = 0; s < n; s += hn::Lanes(f)) {
    const VF u = hn::Iota(f, static_cast<float>(s));
    VF fraction;
    VI ijk[3];
    for (int a = 0; a < 3; ++a) {
      const VF position = hn::MulAdd(u, hn::Set(f, row.step[a]), hn::Set(f, row.start[a]));
      ijk[a] = split(position, grid.axes[a], fraction);
      hn::Store(fraction, f, cells.fraction[a] + s);
    }
    hn::Store(offset_of(grid, ijk[0], ijk[1], ijk[2]), I(), cells.offset + s);
  }
}

HWY_INLINE VF index_along(const PointMap& map, int axis, VF x, VF y, VF z) {
  const F f;
  const float* m = map.matrix[axis];
  const VF far = hn::MulAdd(hn::Set(f, m[2]), z, hn::Set(f, map.offset[axis]));
  return hn::MulAdd(hn::Set(f, m[0]), x, hn::MulAdd(hn::Set(f, m[1]), y, far));
}

void locate_points(const CellGrid& grid, const PointMap& map, const Vec3f* points_P, Cells& cells) {
  const F f;
  const VF half = hn::Set(f, 0.5F);
  for (std::size_t s = 0; s < kChunk; s += hn::Lanes(f)) {
    VF x, y, z;
    hn::LoadInterleaved3(f, points_P[s].data(), x, y, z);
    x = hn::Sub(x, hn::Set(f, map.near_P[0]));
    y = hn::Sub(y, hn::Set(f, map.near_P[1]));
    z = hn::Sub(z, hn::Set(f, map.near_P[2]));

    auto inside = hn::FirstN(f, hn::Lanes(f));
    VF fraction[3];
    VI ijk[3];
    for (int a = 0; a < 3; ++a) {
      const AxisLimits& axis = grid.axes[a];
      const VF position = index_along(map, a, x, y, z);
      const auto within = hn::And(hn::Gt(position, hn::Sub(hn::Set(f, axis.low), half)),
                                  hn::Lt(position, hn::Add(hn::Set(f, axis.high), half)));  // false for NaN
      inside = hn::And(inside, within);
      ijk[a] = split(hn::IfThenElse(within, position, hn::Set(f, axis.low)), axis, fraction[a]);
    }
    fraction[0] = hn::IfThenElse(inside, fraction[0], hn::Set(f, std::numeric_limits<float>::quiet_NaN()));
    for (int a = 0; a < 3; ++a) hn::Store(fraction[a], f, cells.fraction[a] + s);
    hn::Store(offset_of(grid, ijk[0], ijk[1], ijk[2]), I(), cells.offset + s);
  }
}

HWY_INLINE VF lerp(VF a, VF b, VF t) {
  return hn::MulAdd(t, hn::Sub(b, a), a);
}

HWY_INLINE VF lerp_pair(const std::int32_t* HWY_RESTRICT pairs, VF t) {
  const F f;
  const VI pair = hn::Load(I(), pairs);
  const VF low = hn::ConvertTo(f, hn::ShiftRight<16>(hn::ShiftLeft<16>(pair)));
  const VF high = hn::ConvertTo(f, hn::ShiftRight<16>(pair));
  return lerp(low, high, t);
}

void interpolate(const Cells& cells, std::size_t n, float outside, float* HWY_RESTRICT values) {
  const F f;
  for (std::size_t s = 0; s < n; s += hn::Lanes(f)) {
    const VF ti = hn::Load(f, cells.fraction[0] + s);
    const VF tj = hn::Load(f, cells.fraction[1] + s);
    const VF tk = hn::Load(f, cells.fraction[2] + s);
    const VF near_plane = lerp(lerp_pair(cells.pair[0] + s, ti), lerp_pair(cells.pair[1] + s, ti), tj);
    const VF far_plane = lerp(lerp_pair(cells.pair[2] + s, ti), lerp_pair(cells.pair[3] + s, ti), tj);
    const VF value = lerp(near_plane, far_plane, tk);
    hn::StoreU(hn::IfThenElse(hn::Eq(ti, ti), value, hn::Set(f, outside)), f, values + s);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::volume::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::volume::detail {

HWY_EXPORT(locate_row);
HWY_EXPORT(locate_points);
HWY_EXPORT(interpolate);

void locate_row(const CellGrid& grid, const RowWalk& row, std::size_t n, Cells& cells) noexcept {
  HWY_DYNAMIC_DISPATCH(locate_row)(grid, row, n, cells);
}

void locate_points(const CellGrid& grid, const PointMap& map, const Vec3f* points_P, Cells& cells) noexcept {
  HWY_DYNAMIC_DISPATCH(locate_points)(grid, map, points_P, cells);
}

void interpolate(const Cells& cells, std::size_t n, float outside, float* values) noexcept {
  HWY_DYNAMIC_DISPATCH(interpolate)(cells, n, outside, values);
}

void load_pairs(const CellGrid& grid, std::size_t n, Cells& cells) noexcept {
  static_assert(std::endian::native == std::endian::little, "a pair's low half must be its first voxel");
  const std::int16_t* const rows[4] = {grid.voxels, grid.voxels + grid.stride_j, grid.voxels + grid.stride_k,
                                       grid.voxels + grid.stride_j + grid.stride_k};
  for (std::size_t s = 0; s < n; ++s) {
    const std::ptrdiff_t offset = cells.offset[s];
    for (std::size_t r = 0; r < 4; ++r) std::memcpy(&cells.pair[r][s], rows[r] + offset, sizeof(std::int32_t));
  }
}

}  // namespace trocar::volume::detail
#endif
