#include "volume/resample.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/parallel.h"
#include "volume/detail/column_range.h"
#include "volume/sampling.h"

namespace trocar::volume {
namespace {

/// Straight row of voxel centres of a target grid, as fractional indices of the source.
struct Row {
  Vec3 start;
  Vec3 step;
};

Row target_row(const GridGeometry& source, const GridGeometry& target, std::int64_t j, std::int64_t k) {
  const Vec3 first(0.0, static_cast<double>(j), static_cast<double>(k));
  const Vec3 start = source.to_index(target.to_mm(first));
  const Vec3 step =
      (source.R_PV.transpose() * target.R_PV.col(0) * target.spacing_mm.x()).cwiseQuotient(source.spacing_mm);
  return {start, step};
}

/// A k plane of the target as a slice plane.
SlicePlane target_plane(const GridGeometry& target, std::int64_t k) {
  SlicePlane plane;
  plane.origin_P = target.to_mm({0.0, 0.0, static_cast<double>(k)});
  plane.step_u_P = target.R_PV.col(0) * target.spacing_mm.x();
  plane.step_v_P = target.R_PV.col(1) * target.spacing_mm.y();
  plane.columns = static_cast<int>(target.size[0]);
  plane.rows = static_cast<int>(target.size[1]);
  return plane;
}

}  // namespace

CtGrid resample_linear(const CtGrid& source, const GridGeometry& target, std::int16_t outside) {
  CtGrid result(target, outside);
  const auto plane_size = static_cast<std::size_t>(target.size[0] * target.size[1]);
  parallel_for(static_cast<std::size_t>(target.size[2]), 1, [&](std::size_t first, std::size_t last) {
    std::vector<float> values(plane_size);
    for (std::size_t k = first; k < last; ++k) {
      sample_slice(source, target_plane(target, static_cast<std::int64_t>(k)), outside, values);
      std::transform(values.begin(), values.end(), result.voxels.begin() + static_cast<std::ptrdiff_t>(k * plane_size),
                     [](float v) { return static_cast<std::int16_t>(std::floor(v + 0.5F)); });
    }
  });
  return result;
}

LabelGrid resample_nearest(const LabelGrid& source, const GridGeometry& target, std::uint8_t outside) {
  LabelGrid result(target, outside);
  const auto columns = static_cast<int>(target.size[0]);
  const auto rows = static_cast<std::size_t>(target.size[1] * target.size[2]);
  // Half-way places go up, and so do those that a file's rounding has put just below.
  constexpr double kRounding = 1e-4;
  const auto round = [&](double v, std::size_t axis) {
    return std::min(static_cast<std::int64_t>(std::floor(v + 0.5 + kRounding)), source.geometry.size[axis] - 1);
  };
  parallel_for(rows, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t r = first; r < last; ++r) {
      const auto n = static_cast<std::int64_t>(r);
      const Row row = target_row(source.geometry, target, n % target.size[1], n / target.size[1]);
      const auto range = detail::columns_inside(source.geometry, row.start, row.step, columns);
      std::uint8_t* out = result.voxels.data() + r * static_cast<std::size_t>(columns);
      for (int u = range.first; u < range.last; ++u) {
        const Vec3 index = row.start + static_cast<double>(u) * row.step;
        out[u] = source[{round(index.x(), 0), round(index.y(), 1), round(index.z(), 2)}];
      }
    }
  });
  return result;
}

GridGeometry isotropic_geometry(const GridGeometry& source, double spacing_mm) {
  TROCAR_CHECK(spacing_mm > 0.0);
  GridGeometry result = source;
  Vec3 first_centre;  // of the new grid, as an index of the old one
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const double extent_mm = static_cast<double>(source.size[axis]) * source.spacing_mm[a];
    result.size[axis] = std::max<std::int64_t>(1, std::llround(extent_mm / spacing_mm));
    result.spacing_mm[a] = extent_mm / static_cast<double>(result.size[axis]);
    first_centre[a] = 0.5 * result.spacing_mm[a] / source.spacing_mm[a] - 0.5;
  }
  result.origin_P = source.to_mm(first_centre);
  return result;
}

double overlap_fraction(const GridGeometry& source, const GridGeometry& target) {
  if (target.voxel_count() == 0) return 0.0;
  std::int64_t inside = 0;
  for (std::int64_t k = 0; k < target.size[2]; ++k) {
    for (std::int64_t j = 0; j < target.size[1]; ++j) {
      const Row row = target_row(source, target, j, k);
      const auto range = detail::columns_inside(source, row.start, row.step, static_cast<int>(target.size[0]));
      inside += range.last - range.first;
    }
  }
  return static_cast<double>(inside) / static_cast<double>(target.voxel_count());
}

}  // namespace trocar::volume
