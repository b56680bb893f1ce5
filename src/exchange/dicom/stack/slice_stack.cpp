#include "dicom/stack/slice_stack.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/parallel.h"
#include "core/result.h"

namespace trocar::dicom {
namespace {

constexpr double kMaxTilt_deg = 0.3;
constexpr double kMostTilt_deg = 45.0;           ///< Gantries tilt up to 30 degrees; more is another defect.
constexpr std::size_t kMostPlanesPerSlice = 16;  ///< For each slice.
constexpr double kSmallestPixel_mm = 1e-3;
constexpr double kLargestPixel_mm = 1e3;
/// Stored positions may be rounded (0.625 mm steps as 0.6, 1.3, 1.9): maximum deviation of a slice from an even step.
constexpr double kMaxStepDeviation = 0.05;     ///< Fraction of the step.
constexpr double kMaxStepDeviation_mm = 0.06;  ///< At least this much for small steps.
constexpr double kMaxSway_px = 0.5;            ///< Sideways deviation of a slice from a straight stack.
constexpr double kFinestStep = 0.5;            ///< Of the median distance.

Eigen::Vector2d sideways_mm(const SliceStack& stack, std::size_t slice) {
  const Vec3 offset_P = stack.origins_P[slice] - stack.origins_P.front();
  return {offset_P.dot(stack.row_P), offset_P.dot(stack.column_P)};
}

bool has_even_steps(const SliceStack& stack, double mean_mm) {
  const double allowed_mm = std::max(kMaxStepDeviation * mean_mm, kMaxStepDeviation_mm);
  for (std::size_t n = 1; n < stack.origins_P.size(); ++n)
    if (std::abs(stack.along_mm(n) - stack.along_mm(0) - static_cast<double>(n) * mean_mm) > allowed_mm) return false;
  return true;
}

/// The stack leans, or slices deviate sideways from the line through the first and the last one.
bool is_sheared(const SliceStack& stack, double tilt_deg, double extent_mm) {
  if (tilt_deg > kMaxTilt_deg) return true;
  const Eigen::Vector2d last_mm = sideways_mm(stack, stack.origins_P.size() - 1);
  const Eigen::Vector2d pixel_mm(stack.column_step_mm, stack.row_step_mm);
  for (std::size_t n = 1; n + 1 < stack.origins_P.size(); ++n) {
    const double share = (stack.along_mm(n) - stack.along_mm(0)) / extent_mm;
    const Eigen::Vector2d sway_px = (sideways_mm(stack, n) - share * last_mm).cwiseQuotient(pixel_mm);
    if (sway_px.cwiseAbs().maxCoeff() > kMaxSway_px) return true;
  }
  return false;
}

std::vector<StackLayer> plain_layers(std::size_t slices) {
  std::vector<StackLayer> layers;
  for (std::size_t n = 0; n < slices; ++n) layers.push_back({n, n, 0.0});
  return layers;
}

std::vector<StackLayer> even_layers(const SliceStack& stack, std::int64_t planes, double step_mm) {
  std::vector<StackLayer> layers;
  std::size_t below = 0;
  const std::size_t last = stack.origins_P.size() - 1;
  for (std::int64_t k = 0; k < planes; ++k) {
    const double at_mm = stack.along_mm(0) + static_cast<double>(k) * step_mm;
    while (below + 1 < last && stack.along_mm(below + 1) <= at_mm) ++below;
    const double gap_mm = stack.along_mm(below + 1) - stack.along_mm(below);
    layers.push_back({below, below + 1, std::clamp((at_mm - stack.along_mm(below)) / gap_mm, 0.0, 1.0)});
  }
  return layers;
}

/// The smallest distance of two slices, but at least half of the usual one.
double even_step_mm(const SliceStack& stack) {
  const double median_mm = widest_gap(stack).median_mm;
  double smallest_mm = median_mm;
  for (std::size_t n = 1; n < stack.origins_P.size(); ++n)
    smallest_mm = std::min(smallest_mm, stack.along_mm(n) - stack.along_mm(n - 1));
  return std::max(kFinestStep * median_mm, smallest_mm);
}

/// Widens the grid so that it holds all slices, and notes where each lies in it.
void straighten(const SliceStack& stack, StackPlan& plan) {
  const Eigen::Vector2d pixel_mm(stack.column_step_mm, stack.row_step_mm);
  Eigen::Vector2d low_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d high_px = Eigen::Vector2d::Zero();
  for (std::size_t n = 0; n < stack.origins_P.size(); ++n) {
    const Eigen::Vector2d at_px = sideways_mm(stack, n).cwiseQuotient(pixel_mm);
    plan.offsets_px.push_back(at_px);
    plan.shift_mm = std::max(plan.shift_mm, sideways_mm(stack, n).norm());
    low_px = low_px.cwiseMin(at_px);
    high_px = high_px.cwiseMax(at_px);
  }
  low_px = low_px.array().floor();
  for (Eigen::Vector2d& offset_px : plan.offsets_px) offset_px -= low_px;
  plan.geometry.size[0] += static_cast<std::int64_t>(std::ceil(high_px.x()) - low_px.x());
  plan.geometry.size[1] += static_cast<std::int64_t>(std::ceil(high_px.y()) - low_px.y());
  plan.geometry.origin_P += stack.row_P * (low_px.x() * pixel_mm.x()) + stack.column_P * (low_px.y() * pixel_mm.y());
}

/// The pixels of one slice, read at places of the grid's plane.
template <class T>
class ShiftedSlice {
 public:
  ShiftedSlice(const SliceStack& stack, const std::vector<T>& slices, std::size_t slice,
               const Eigen::Vector2d& offset_px)
      : pixels_(slices.data() + slice * static_cast<std::size_t>(stack.columns * stack.rows)),
        columns_(stack.columns),
        rows_(stack.rows),
        offset_px_(offset_px) {}

  T nearest(std::int64_t i, std::int64_t j, T outside) const {
    const std::int64_t column = i - std::lround(offset_px_.x());
    const std::int64_t row = j - std::lround(offset_px_.y());
    return column < 0 || row < 0 || column >= columns_ || row >= rows_ ? outside : at(column, row);
  }

  /// The edge values continue for the outer half pixel.
  double linear(std::int64_t i, std::int64_t j, T outside) const {
    const double x = static_cast<double>(i) - offset_px_.x();
    const double y = static_cast<double>(j) - offset_px_.y();
    if (x < -0.5 || y < -0.5 || x > static_cast<double>(columns_) - 0.5 || y > static_cast<double>(rows_) - 0.5)
      return static_cast<double>(outside);
    const double cx = std::clamp(x, 0.0, static_cast<double>(columns_ - 1));
    const double cy = std::clamp(y, 0.0, static_cast<double>(rows_ - 1));
    const std::int64_t c0 = std::min(static_cast<std::int64_t>(cx), std::max<std::int64_t>(columns_ - 2, 0));
    const std::int64_t r0 = std::min(static_cast<std::int64_t>(cy), std::max<std::int64_t>(rows_ - 2, 0));
    const std::int64_t c1 = std::min(c0 + 1, columns_ - 1);
    const std::int64_t r1 = std::min(r0 + 1, rows_ - 1);
    const double fx = cx - static_cast<double>(c0);
    const double fy = cy - static_cast<double>(r0);
    const double upper = std::lerp(static_cast<double>(at(c0, r0)), static_cast<double>(at(c1, r0)), fx);
    const double lower = std::lerp(static_cast<double>(at(c0, r1)), static_cast<double>(at(c1, r1)), fx);
    return std::lerp(upper, lower, fy);
  }

 private:
  T at(std::int64_t column, std::int64_t row) const { return pixels_[row * columns_ + column]; }
  const T* pixels_;
  std::int64_t columns_;
  std::int64_t rows_;
  Eigen::Vector2d offset_px_;
};

template <class T>
void fill_plane(const StackPlan& plan, const SliceStack& stack, const std::vector<T>& slices, T outside, std::size_t k,
                volume::Grid<T>& grid) {
  const StackLayer& layer = plan.layers[k];
  const ShiftedSlice<T> below(stack, slices, layer.below, plan.offsets_px[layer.below]);
  const ShiftedSlice<T> above(stack, slices, layer.above, plan.offsets_px[layer.above]);
  const auto [columns, rows, planes] = grid.geometry.size;
  T* out = grid.voxels.data() + k * static_cast<std::size_t>(columns * rows);
  for (std::int64_t j = 0; j < rows; ++j)
    for (std::int64_t i = 0; i < columns; ++i, ++out) {
      if constexpr (std::is_same_v<T, std::uint8_t>) {
        *out = (layer.weight_above < 0.5 ? below : above).nearest(i, j, outside);
        continue;
      }
      double value = below.linear(i, j, outside);
      if (layer.weight_above > 0.0) value = std::lerp(value, above.linear(i, j, outside), layer.weight_above);
      *out = static_cast<T>(std::is_integral_v<T> ? std::round(value) : value);
    }
}

}  // namespace

StackGap widest_gap(const SliceStack& stack) {
  StackGap widest;
  std::vector<double> gaps_mm;
  for (std::size_t n = 0; n + 1 < stack.origins_P.size(); ++n) {
    gaps_mm.push_back(stack.along_mm(n + 1) - stack.along_mm(n));
    if (gaps_mm.back() > widest.gap_mm) widest = {n, gaps_mm.back(), 0.0};
  }
  if (gaps_mm.empty()) return widest;
  const auto middle = gaps_mm.begin() + static_cast<std::ptrdiff_t>(gaps_mm.size() / 2);
  std::nth_element(gaps_mm.begin(), middle, gaps_mm.end());
  widest.median_mm = *middle;
  return widest;
}

double tilt_deg(const SliceStack& stack) {
  const std::size_t last = stack.origins_P.size() - 1;
  const double extent_mm = stack.along_mm(last) - stack.along_mm(0);
  return degrees(std::atan2(sideways_mm(stack, last).norm(), extent_mm));
}

bool is_uneven(const SliceStack& stack) {
  if (stack.origins_P.size() < 2) return false;
  const std::size_t last = stack.origins_P.size() - 1;
  return !has_even_steps(stack, (stack.along_mm(last) - stack.along_mm(0)) / static_cast<double>(last));
}

bool is_sane(const SliceStack& stack) {
  const auto is_pixel = [](double mm) { return mm >= kSmallestPixel_mm && mm <= kLargestPixel_mm; };
  const auto is_near = [](const Vec3& p_P) { return p_P.allFinite() && p_P.cwiseAbs().maxCoeff() <= kFarthest_mm; };
  return is_pixel(stack.column_step_mm) && is_pixel(stack.row_step_mm) &&
         std::all_of(stack.origins_P.begin(), stack.origins_P.end(), is_near);
}

std::optional<StackPlan> plan_stack(const SliceStack& stack, double single_step_mm) {
  TROCAR_CHECK(!stack.origins_P.empty() && single_step_mm > 0.0);
  const std::size_t count = stack.origins_P.size();
  StackPlan plan;
  plan.geometry.size = {stack.columns, stack.rows, static_cast<std::int64_t>(count)};
  plan.geometry.spacing_mm = {stack.column_step_mm, stack.row_step_mm, single_step_mm};
  plan.geometry.origin_P = stack.origins_P.front();
  plan.geometry.R_PV << stack.row_P, stack.column_P, stack.normal_P();
  if (count == 1) return plan;

  const double extent_mm = stack.along_mm(count - 1) - stack.along_mm(0);
  plan.geometry.spacing_mm.z() = extent_mm / static_cast<double>(count - 1);
  plan.tilt_deg = tilt_deg(stack);
  plan.is_uneven = is_uneven(stack);
  const bool has_shear = is_sheared(stack, plan.tilt_deg, extent_mm);
  plan.is_plain = !plan.is_uneven && !has_shear;
  if (plan.is_plain) return plan;
  if (plan.tilt_deg > kMostTilt_deg) return std::nullopt;

  if (plan.is_uneven) {
    const double planes = std::max(std::round(extent_mm / even_step_mm(stack)), 1.0) + 1.0;
    if (planes > static_cast<double>(kMostPlanesPerSlice * count)) return std::nullopt;
    plan.geometry.size[2] = static_cast<std::int64_t>(planes);
    plan.geometry.spacing_mm.z() = extent_mm / (planes - 1.0);
    plan.layers = even_layers(stack, plan.geometry.size[2], plan.geometry.spacing_mm.z());
  } else {
    plan.layers = plain_layers(count);
  }
  if (has_shear)
    straighten(stack, plan);
  else
    plan.offsets_px.assign(count, Eigen::Vector2d::Zero());
  return plan;
}

template <class T>
volume::Grid<T> fill_from_stack(const StackPlan& plan, const SliceStack& stack, std::vector<T> slices, T outside) {
  TROCAR_CHECK(slices.size() == stack.origins_P.size() * static_cast<std::size_t>(stack.columns * stack.rows));
  volume::Grid<T> grid;
  grid.geometry = plan.geometry;
  if (plan.is_plain) {
    grid.voxels = std::move(slices);
    return grid;
  }
  grid.voxels.resize(grid.geometry.voxel_count());
  parallel_for(plan.layers.size(), 4, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) fill_plane(plan, stack, slices, outside, k, grid);
  });
  return grid;
}

template volume::Grid<std::int16_t> fill_from_stack(const StackPlan&, const SliceStack&, std::vector<std::int16_t>,
                                                    std::int16_t);
template volume::Grid<std::uint8_t> fill_from_stack(const StackPlan&, const SliceStack&, std::vector<std::uint8_t>,
                                                    std::uint8_t);
template volume::Grid<float> fill_from_stack(const StackPlan&, const SliceStack&, std::vector<float>, float);

}  // namespace trocar::dicom
