#include "xray/projection/detail/slab_kernels.h"

#include <algorithm>
#include <cmath>

// Compiled for each instruction set by foreach_target.h; selected at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "xray/projection/detail/slab_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that this header compiles for.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trocar::xray::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::ScalableTag<float>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;

template <class Voxel>
inline constexpr int kChannels = 1;
template <>
inline constexpr int kChannels<PackedVoxel> = 2;

/// Two neighbouring rows of a slice and their weights; the voxels that are not zero in both together.
template <class Voxel>
struct RowPair {
  const Voxel* a = nullptr;
  const Voxel* b = nullptr;
  float weight_a = 0.0F, weight_b = 0.0F;
  std::int32_t begin = 0, end = 0;
};

template <class Voxel>
RowPair<Voxel> pair_at(const RowsView<Voxel>& view, std::int64_t slice, double y) {
  RowPair<Voxel> pair;
  if (!(y > -1.0 && y < static_cast<double>(view.count_y))) return pair;
  const double floor_y = std::floor(y);
  const auto j = static_cast<std::int64_t>(floor_y);
  const auto f = static_cast<float>(y - floor_y);
  const RowSpan* const rows = view.rows + slice * view.stride_n;
  const auto add = [&](std::int64_t at, float weight, const Voxel*& voxels, float& to) {
    const RowSpan& row = rows[std::clamp<std::int64_t>(at, 0, view.count_y - 1) * view.stride_y];
    voxels = view.voxels + row.first;
    if (at < 0 || at >= view.count_y) return;  // beyond the volume: weight 0
    to = weight;
    if (row.begin == row.end) return;
    if (pair.begin == pair.end) {
      pair.begin = row.begin;
      pair.end = row.end;
      return;
    }
    pair.begin = std::min(pair.begin, row.begin);
    pair.end = std::max(pair.end, row.end);
  };
  add(j, 1.0F - f, pair.a, pair.weight_a);
  add(j + 1, f, pair.b, pair.weight_b);
  return pair;
}

/// Blends a pair into `blended`, one row a channel, from the voxel before the first one; zeros at both ends.
HWY_INLINE void blend(const RowPair<PackedVoxel>& pair, float* HWY_RESTRICT water, float* HWY_RESTRICT bone) {
  const F f;
  const I i;
  const VF wa = hn::Set(f, pair.weight_a), wb = hn::Set(f, pair.weight_b);
  std::int32_t x = pair.begin;
  water[0] = bone[0] = 0.0F;
  for (std::size_t n = 1; x < pair.end; n += hn::Lanes(f), x += static_cast<std::int32_t>(hn::Lanes(f))) {
    const VI a = hn::LoadU(i, pair.a + x), b = hn::LoadU(i, pair.b + x);
    const VF water_a = hn::ConvertTo(f, hn::ShiftRight<16>(hn::ShiftLeft<16>(a)));
    const VF water_b = hn::ConvertTo(f, hn::ShiftRight<16>(hn::ShiftLeft<16>(b)));
    hn::StoreU(hn::MulAdd(wa, water_a, hn::Mul(wb, water_b)), f, water + n);
    const VF bone_a = hn::ConvertTo(f, hn::ShiftRight<16>(a)), bone_b = hn::ConvertTo(f, hn::ShiftRight<16>(b));
    hn::StoreU(hn::MulAdd(wa, bone_a, hn::Mul(wb, bone_b)), f, bone + n);
  }
}

HWY_INLINE void blend(const RowPair<float>& pair, float* HWY_RESTRICT value, float*) {
  const F f;
  const VF wa = hn::Set(f, pair.weight_a), wb = hn::Set(f, pair.weight_b);
  std::int32_t x = pair.begin;
  value[0] = 0.0F;
  for (std::size_t n = 1; x < pair.end; n += hn::Lanes(f), x += static_cast<std::int32_t>(hn::Lanes(f)))
    hn::StoreU(hn::MulAdd(wa, hn::LoadU(f, pair.a + x), hn::Mul(wb, hn::LoadU(f, pair.b + x))), f, value + n);
}

HWY_INLINE void set_zero(float* values) {
  const F f;
  hn::StoreU(hn::Zero(f), f, values);
  hn::StoreU(hn::Zero(f), f, values + hn::Lanes(f));
}

/// Samples of a row: sample u lies at voxel start + step * u of a blended row.
struct SampleRow {
  double start, step;
  int first, last;  ///< Samples that meet the row.
};

/// Adds the linear interpolations of the blended rows. The voxels of a vector of samples are as many as its lanes, or
/// fewer (kLargestStep), so that they are loaded together and then permuted.
template <int kCount>
HWY_INLINE void add_samples(const SampleRow& row, const float* const* HWY_RESTRICT blended,
                            float* const* HWY_RESTRICT sums) {
  const F f;
  const I i;
  const auto lanes = static_cast<int>(hn::Lanes(f));
  const VF steps = hn::Mul(hn::Iota(f, 0.0F), hn::Set(f, static_cast<float>(row.step)));
  for (int u = row.first; u <= row.last; u += lanes) {
    const double start = row.start + row.step * u;
    const double whole = std::floor(start);
    const auto base = static_cast<std::ptrdiff_t>(whole);
    const VF position = hn::Add(steps, hn::Set(f, static_cast<float>(start - whole)));
    const VI index = hn::ConvertTo(i, position);
    const VF share = hn::Sub(position, hn::ConvertTo(f, index));
    const auto table = hn::IndicesFromVec(f, index);
    for (int c = 0; c < kCount; ++c) {
      const VF low = hn::TableLookupLanes(hn::LoadU(f, blended[c] + base), table);
      const VF high = hn::TableLookupLanes(hn::LoadU(f, blended[c] + base + 1), table);
      const VF value = hn::MulAdd(share, hn::Sub(high, low), low);
      hn::StoreU(hn::Add(hn::LoadU(f, sums[c] + u), value), f, sums[c] + u);
    }
  }
}

template <class Voxel>
void sum_rows(const RowsView<Voxel>& view, const SlabPlan& plan, int first, int last, float* scratch,
              std::size_t scratch_stride, SlabSums& sums) {
  float* const blended[2] = {scratch, scratch + scratch_stride};
  const float* const read[2] = {blended[0], blended[1]};
  const double distance = plan.plane - plan.source_n;
  for (int slice = plan.first_slice; slice <= plan.last_slice; ++slice) {
    const double scale = (slice - plan.source_n) / distance;
    const double step = plan.step_x * scale, start = plan.source_x + (plan.x - plan.source_x) * scale;
    for (int v = first; v < last; ++v) {
      const double y = plan.source_y + (plan.y + v * plan.step_y - plan.source_y) * scale;
      const RowPair<Voxel> pair = pair_at(view, slice, y);
      if (pair.begin == pair.end) continue;
      const double from = pair.begin - 1, to = pair.end;  // beyond, the interpolation is zero
      SampleRow row{start - from, step, 0, 0};
      row.first = static_cast<int>(std::max(0.0, std::ceil((from - start) / step)));
      row.last = static_cast<int>(std::min(plan.columns - 1.0, std::floor((to - start) / step)));
      if (row.first > row.last) continue;
      blend(pair, blended[0], blended[1]);
      for (int c = 0; c < kChannels<Voxel>; ++c) set_zero(blended[c] + (pair.end - pair.begin + 1));
      float* out[2] = {};
      for (int c = 0; c < kChannels<Voxel>; ++c)
        out[c] = sums.channels[static_cast<std::size_t>(c)].data() + static_cast<std::size_t>(v) * sums.stride;
      add_samples<kChannels<Voxel>>(row, read, out);
    }
  }
}

void sum_packed(const RowsView<PackedVoxel>& view, const SlabPlan& plan, int first, int last, float* scratch,
                std::size_t scratch_stride, SlabSums& sums) {
  sum_rows(view, plan, first, last, scratch, scratch_stride, sums);
}

void sum_floats(const RowsView<float>& view, const SlabPlan& plan, int first, int last, float* scratch,
                std::size_t scratch_stride, SlabSums& sums) {
  sum_rows(view, plan, first, last, scratch, scratch_stride, sums);
}

/// One axis of the directions of a row of pixels.
HWY_INLINE VF along(const std::array<float, 2>& linear, VF column) {
  const F f;
  return hn::MulAdd(column, hn::Set(f, linear[1]), hn::Set(f, linear[0]));
}

HWY_INLINE VF clamped(VF v, float high) {
  const F f;
  return hn::Min(hn::Max(v, hn::Zero(f)), hn::Set(f, high));
}

void read_row(const PixelRow& row, const float* HWY_RESTRICT sums, float factor, int count, float* HWY_RESTRICT out) {
  const F f;
  const I i;
  const auto lanes = static_cast<int>(hn::Lanes(f));
  const VF one = hn::Set(f, 1.0F);
  for (int c = 0; c < count; c += lanes) {
    const VF column = hn::Iota(f, static_cast<float>(c));
    const VF dx = along(row.direction[0], column), dy = along(row.direction[1], column);
    const VF per_n = hn::Div(one, along(row.direction[2], column));
    const VF slope_x = hn::Mul(dx, per_n), slope_y = hn::Mul(dy, per_n);
    const VF u = hn::MulAdd(slope_x, hn::Set(f, row.per_slope[0]), hn::Set(f, row.origin[0]));
    const VF v = hn::MulAdd(slope_y, hn::Set(f, row.per_slope[1]), hn::Set(f, row.origin[1]));
    const float last_u = static_cast<float>(row.columns - 1), last_v = static_cast<float>(row.rows - 1);
    const VF in_u = clamped(u, last_u), in_v = clamped(v, last_v);
    const auto inside = hn::And(hn::Eq(in_u, u), hn::Eq(in_v, v));
    const VF cell_u = hn::Floor(hn::Min(in_u, hn::Set(f, last_u - 0.5F)));
    const VF cell_v = hn::Floor(hn::Min(in_v, hn::Set(f, last_v - 0.5F)));
    const VF fu = hn::Sub(in_u, cell_u), fv = hn::Sub(in_v, cell_v);
    const VI at = hn::Add(hn::ConvertTo(i, cell_u), hn::Mul(hn::ConvertTo(i, cell_v), hn::Set(i, row.stride)));
    const VF p00 = hn::GatherIndex(f, sums, at), p10 = hn::GatherIndex(f, sums + 1, at);
    const VF p01 = hn::GatherIndex(f, sums + row.stride, at), p11 = hn::GatherIndex(f, sums + row.stride + 1, at);
    const VF low = hn::MulAdd(fu, hn::Sub(p10, p00), p00), high = hn::MulAdd(fu, hn::Sub(p11, p01), p01);
    const VF value = hn::MulAdd(fv, hn::Sub(high, low), low);
    const VF x_mm = hn::Mul(slope_x, hn::Set(f, row.spacing_mm[0])),
             y_mm = hn::Mul(slope_y, hn::Set(f, row.spacing_mm[1]));
    const VF n_mm = hn::Set(f, row.spacing_mm[2]);
    const VF length_mm = hn::Sqrt(hn::MulAdd(x_mm, x_mm, hn::MulAdd(y_mm, y_mm, hn::Mul(n_mm, n_mm))));
    const VF result = hn::IfThenElseZero(inside, hn::Mul(hn::Mul(value, length_mm), hn::Set(f, factor)));
    if (c + lanes <= count) {
      hn::StoreU(result, f, out + c);
    } else {
      HWY_ALIGN float rest[HWY_MAX_BYTES / sizeof(float)];
      hn::Store(result, f, rest);
      std::copy(rest, rest + (count - c), out + c);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::xray::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::xray::detail {

HWY_EXPORT(sum_packed);
HWY_EXPORT(sum_floats);
HWY_EXPORT(read_row);

namespace {

/// Room for a blended row of each channel: a zero at each end, and what vectors read and write beyond.
constexpr std::size_t stride_of(std::int64_t length) noexcept {
  return static_cast<std::size_t>(length) + 2 + 4 * kSamplePadding;
}

}  // namespace

void sum_slices(const RowsView<PackedVoxel>& view, const SlabPlan& plan, int first, int last, SlabSums& sums) {
  const std::size_t stride = stride_of(view.length);
  std::vector<float> scratch(2 * stride);
  HWY_DYNAMIC_DISPATCH(sum_packed)(view, plan, first, last, scratch.data(), stride, sums);
}

void sum_slices(const RowsView<float>& view, const SlabPlan& plan, int first, int last, SlabSums& sums) {
  const std::size_t stride = stride_of(view.length);
  std::vector<float> scratch(2 * stride);
  HWY_DYNAMIC_DISPATCH(sum_floats)(view, plan, first, last, scratch.data(), stride, sums);
}

void read_sums(const SlabSums& sums, int channel, const SlabPlan& plan, const IndexRays& rays, float factor, int first,
               int last, int image_columns, float* image) {
  const int axes[3] = {plan.axis_x, plan.axis_y, plan.axis_n};
  PixelRow row{};
  row.columns = plan.columns;
  row.rows = plan.rows;
  row.stride = static_cast<int>(sums.stride);
  const double distance = plan.plane - plan.source_n;
  row.origin[0] = static_cast<float>((plan.source_x - plan.x) / plan.step_x);
  row.origin[1] = static_cast<float>((plan.source_y - plan.y) / plan.step_y);
  row.per_slope[0] = static_cast<float>(distance / plan.step_x);
  row.per_slope[1] = static_cast<float>(distance / plan.step_y);
  for (int a = 0; a < 3; ++a) row.spacing_mm[a] = static_cast<float>(rays.spacing_mm[axes[a]]);
  for (int r = first; r < last; ++r) {
    const Vec3 start = rays.direction + plan.tile.column * rays.per_column + (plan.tile.row + r) * rays.per_row;
    for (int a = 0; a < 3; ++a) {
      row.direction[a][0] = static_cast<float>(start[axes[a]]);
      row.direction[a][1] = static_cast<float>(rays.per_column[axes[a]]);
    }
    float* const out = image + static_cast<std::ptrdiff_t>(plan.tile.row + r) * image_columns + plan.tile.column;
    HWY_DYNAMIC_DISPATCH(read_row)
    (row, sums.channels[static_cast<std::size_t>(channel)].data(), factor, plan.tile.columns, out);
  }
}

}  // namespace trocar::xray::detail
#endif
