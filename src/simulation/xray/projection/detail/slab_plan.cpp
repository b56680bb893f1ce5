#include "xray/projection/detail/slab_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trocar::xray::detail {
namespace {

constexpr double kSteepest = 2.0;    ///< Voxels that a ray may move sideways from slice to slice.
constexpr int kSmallestTile = 8;     ///< Pixels along an edge below which a tile is not divided.
constexpr double kFinestStep = 0.4;  ///< Voxels; finer samples of a linear interpolation contain nothing new.
constexpr double kNearSource = 0.5;  ///< Slices nearer to the source are left out.
constexpr double kTinyDirection = 1e-9;

struct PlaneExtent {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void add(double value) noexcept {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

Vec3 direction_of(const IndexRays& rays, double column, double row) noexcept {
  return rays.direction + column * rays.per_column + row * rays.per_row;
}

/// Corners and middle of a tile, as pixels.
std::array<std::array<double, 2>, 5> places_of(const DetectorTile& tile) noexcept {
  const double left = tile.column, right = tile.column + tile.columns - 1;
  const double top = tile.row, bottom = tile.row + tile.rows - 1;
  return {{{left, top}, {right, top}, {left, bottom}, {right, bottom}, {0.5 * (left + right), 0.5 * (top + bottom)}}};
}

int main_axis(const Vec3& direction) noexcept {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return axis;
}

bool is_too_steep(const IndexRays& rays, const DetectorTile& tile, int axis) noexcept {
  const Vec3 middle = direction_of(rays, places_of(tile)[4][0], places_of(tile)[4][1]);
  for (const auto& [column, row] : places_of(tile)) {
    const Vec3 d = direction_of(rays, column, row);
    if (!(d[axis] * middle[axis] > 0.0) || d.cwiseAbs().maxCoeff() > kSteepest * std::abs(d[axis])) return true;
  }
  return false;
}

/// Where the plane cuts the ray of a pixel, along one axis.
double on_plane(const IndexRays& rays, const SlabPlan& plan, int axis, double column, double row) noexcept {
  const Vec3 d = direction_of(rays, column, row);
  return rays.source[axis] + d[axis] / d[plan.axis_n] * (plan.plane - plan.source_n);
}

struct Samples {
  double start = 0.0, step = 1.0;
  int count = 0;
};

/// Samples on the plane along one axis: what both the tile and the volume's shadow cover, as fine as the pixels are.
Samples samples_along(const IndexRays& rays, const SlabPlan& plan, int axis, double size,
                      double largest_step) noexcept {
  PlaneExtent tile, shadow;
  double step = largest_step;
  for (const auto& [column, row] : places_of(plan.tile)) {
    const double here = on_plane(rays, plan, axis, column, row);
    tile.add(here);
    step = std::min(step, std::hypot(on_plane(rays, plan, axis, column + 1.0, row) - here,
                                     on_plane(rays, plan, axis, column, row + 1.0) - here));
  }
  step = std::clamp(step, std::min(kFinestStep, largest_step), largest_step);
  for (const int slice : {plan.first_slice, plan.last_slice}) {
    const double scale = (slice - plan.source_n) / (plan.plane - plan.source_n);
    for (const double edge : {-1.0, size}) shadow.add(rays.source[axis] + (edge - rays.source[axis]) / scale);
  }
  // One sample more at each side: the outermost pixels lie inside, whatever their rounding.
  const double low = std::max(tile.low - step, shadow.low), high = std::min(tile.high + step, shadow.high);
  if (!(low <= high)) return {};
  return {low, step, static_cast<int>(std::ceil((high - low) / step)) + 2};
}

void add_plans(const IndexRays& rays, const DetectorTile& tile, const std::array<std::int64_t, 3>& size,
               std::vector<SlabPlan>& plans) {
  SlabPlan plan;
  plan.tile = tile;
  const Vec3 middle = direction_of(rays, places_of(tile)[4][0], places_of(tile)[4][1]);
  plan.axis_n = main_axis(middle);
  if (is_too_steep(rays, tile, plan.axis_n) && std::max(tile.columns, tile.rows) > kSmallestTile) {
    DetectorTile a = tile, b = tile;
    if (tile.columns >= tile.rows) {
      a.columns = tile.columns / 2;
      b.column += a.columns;
      b.columns -= a.columns;
    } else {
      a.rows = tile.rows / 2;
      b.row += a.rows;
      b.rows -= a.rows;
    }
    add_plans(rays, a, size, plans);
    add_plans(rays, b, size, plans);
    return;
  }
  // Rows run along index axis 0, or along 1 in the transposed copy.
  plan.axis_x = plan.axis_n == 0 ? 1 : 0;
  plan.axis_y = 3 - plan.axis_n - plan.axis_x;
  plan.source_x = rays.source[plan.axis_x];
  plan.source_y = rays.source[plan.axis_y];
  plan.source_n = rays.source[plan.axis_n];
  const auto last = static_cast<double>(size[static_cast<std::size_t>(plan.axis_n)] - 1);
  const bool rises = middle[plan.axis_n] > 0.0;
  const double low = rises ? std::max(0.0, std::ceil(plan.source_n + kNearSource)) : 0.0;
  const double high = rises ? last : std::min(last, std::floor(plan.source_n - kNearSource));
  plans.push_back(plan);
  if (!(low <= high) || std::abs(middle[plan.axis_n]) < kTinyDirection) return;
  SlabPlan& full = plans.back();
  full.first_slice = static_cast<int>(low);
  full.last_slice = static_cast<int>(high);
  full.plane = 0.5 * (low + high);
  const double largest_scale =
      std::max(std::abs(low - full.source_n), std::abs(high - full.source_n)) / std::abs(full.plane - full.source_n);
  const auto along = [&](int axis) {
    return samples_along(rays, full, axis, static_cast<double>(size[static_cast<std::size_t>(axis)]),
                         kLargestStep / largest_scale);
  };
  const Samples x = along(full.axis_x), y = along(full.axis_y);
  if (x.count == 0 || y.count == 0) return;
  full.x = x.start;
  full.step_x = x.step;
  full.columns = x.count;
  full.y = y.start;
  full.step_y = y.step;
  full.rows = y.count;
}

}  // namespace

IndexRays index_rays(const XrayRays& rays, const volume::GridGeometry& geometry) noexcept {
  const Mat3 R_VP = geometry.R_PV.transpose();
  const auto to_index = [&](const Vec3& v_P) -> Vec3 { return (R_VP * v_P).cwiseQuotient(geometry.spacing_mm); };
  return {geometry.to_index(rays.source_P), to_index(rays.first_pixel_P - rays.source_P), to_index(rays.column_P),
          to_index(rays.row_P), geometry.spacing_mm};
}

std::vector<SlabPlan> plan_slabs(const IndexRays& rays, int columns, int rows,
                                 const std::array<std::int64_t, 3>& size) {
  std::vector<SlabPlan> plans;
  if (columns > 0 && rows > 0 && size[0] > 0 && size[1] > 0 && size[2] > 0 && rays.source.allFinite() &&
      rays.direction.allFinite())
    add_plans(rays, {0, 0, columns, rows}, size, plans);
  return plans;
}

}  // namespace trocar::xray::detail
