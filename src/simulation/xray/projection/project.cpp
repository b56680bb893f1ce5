#include "xray/projection/project.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/parallel.h"
#include "xray/projection/detail/packed_volume.h"
#include "xray/projection/detail/slab_kernels.h"

namespace trocar::xray {
namespace {

using detail::IndexRays;
using detail::RowStack;
using detail::RowsView;
using detail::SlabPlan;
using detail::SlabSums;

constexpr std::size_t kGrainSums = 8, kGrainRows = 16;  ///< Rows of a part of the work.
constexpr float kCmPerMm = 0.1F;

/// The rows that a plan walks: along index axis 0 of the volume, or along axis 1 in the transposed copy.
template <class Voxel>
RowsView<Voxel> view_of(const RowStack<Voxel>& stack, const SlabPlan& plan) {
  RowsView<Voxel> view{stack.rows.data(), stack.voxels.data(), stack.length, stack.size_a, 1, stack.size_a};
  // Rows of a stack are numbered by axes (1, 2), or (0, 2) if transposed. Slices across the first of them:
  if (plan.axis_n != 2) {
    view.count_y = stack.size_b;
    std::swap(view.stride_y, view.stride_n);
  }
  return view;
}

template <class Voxel>
SlabSums sum_plan(const RowStack<Voxel>& stack, const SlabPlan& plan, std::size_t channels) {
  SlabSums sums;
  sums.stride = static_cast<std::size_t>(plan.columns) + detail::kSamplePadding;
  for (std::size_t c = 0; c < channels; ++c) sums.channels[c].resize(sums.stride * static_cast<std::size_t>(plan.rows));
  const RowsView<Voxel> view = view_of(stack, plan);
  parallel_for(static_cast<std::size_t>(plan.rows), kGrainSums, [&](std::size_t first, std::size_t last) {
    detail::sum_slices(view, plan, static_cast<int>(first), static_cast<int>(last), sums);
  });
  return sums;
}

/// Projects a volume: `stack_for(plan)` is its rows, `images` are zero.
template <class StackFor>
void project_stack(const IndexRays& rays, int columns, int rows, const std::array<std::int64_t, 3>& size,
                   const StackFor& stack_for, std::span<float* const> images, float factor) {
  for (const SlabPlan& plan : detail::plan_slabs(rays, columns, rows, size)) {
    if (plan.columns == 0) continue;
    const SlabSums sums = sum_plan(stack_for(plan), plan, images.size());
    parallel_for(static_cast<std::size_t>(plan.tile.rows), kGrainRows, [&](std::size_t first, std::size_t last) {
      for (std::size_t c = 0; c < images.size(); ++c)
        detail::read_sums(sums, static_cast<int>(c), plan, rays, factor, static_cast<int>(first),
                          static_cast<int>(last), columns, images[c]);
    });
  }
}

RowStack<float> rows_of(const volume::FloatGrid& grid, bool is_transposed) {
  const auto [i, j, k] = grid.geometry.size;
  const float* const voxels = grid.voxels.data();
  if (is_transposed)
    return detail::make_row_stack<float>(j, i, k,
                                         [=, size_i = i, size_j = j](std::int64_t x, std::int64_t a, std::int64_t b) {
                                           return voxels[(b * size_j + x) * size_i + a];
                                         });
  return detail::make_row_stack<float>(i, j, k,
                                       [=, size_i = i, size_j = j](std::int64_t x, std::int64_t a, std::int64_t b) {
                                         return voxels[(b * size_j + a) * size_i + x];
                                       });
}

}  // namespace

void project(const XrayVolume& volume, const XrayRays& rays, MassImage& masses) {
  const XrayVolume::Impl& impl = volume.impl();
  masses.columns = rays.columns;
  masses.rows = rays.rows;
  float* images[2] = {};
  for (const Basis basis : {Basis::kWater, Basis::kBone}) {
    std::vector<float>& image = masses.of(basis);
    image.assign(masses.size(), 0.0F);
    images[static_cast<std::size_t>(basis)] = image.data();
  }
  const IndexRays in_volume = detail::index_rays(rays, impl.geometry);
  const auto stack_for = [&](const SlabPlan& plan) -> const RowStack<detail::PackedVoxel>& {
    return plan.axis_n == 0 ? impl.transposed : impl.rows;
  };
  project_stack(in_volume, rays.columns, rays.rows, impl.geometry.size, stack_for, images,
                kCmPerMm * static_cast<float>(detail::kPackedUnit_g_per_cm3));
}

void project(const volume::FloatGrid& grid, const XrayRays& rays, std::vector<float>& integrals) {
  integrals.assign(
      static_cast<std::size_t>(std::max(rays.columns, 0)) * static_cast<std::size_t>(std::max(rays.rows, 0)), 0.0F);
  if (grid.empty()) return;
  float* const images[1] = {integrals.data()};
  const auto stack_for = [&](const SlabPlan& plan) { return rows_of(grid, plan.axis_n == 0); };
  project_stack(detail::index_rays(rays, grid.geometry), rays.columns, rays.rows, grid.geometry.size, stack_for, images,
                kCmPerMm);
}

}  // namespace trocar::xray
