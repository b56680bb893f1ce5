#include "ultrasound/engine/detail/border_fit.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace trocar::ultrasound::detail {
namespace {

/// To each side: several voxels, and less than the curvature radius of most organs.
constexpr double kFitReach_mm = 3.0;
constexpr int kMostSteps = 4;        ///< Scanlines to each side.
constexpr float kSteepest = 1.7F;    ///< Largest slope followed from line to line,
constexpr float kRamp = 16.0F;       ///< Samples.
constexpr float kFitStep_mm = 1.2F;  ///< in addition to the step of a voxel.

std::span<const BorderKey> borders_of(const ScanPlan& plan, const FrameState& frame, int plane, int line) noexcept {
  const auto at = static_cast<std::size_t>(plan.row_of(plane, line));
  return {frame.border_keys.data() + at * kMaxBorders, frame.border_counts[at]};
}

/// The border between two tissues nearest to a position; nullptr: none within `reach` samples. They are sorted by
/// depth, up to two per ramp.
const BorderKey* find_near(std::span<const BorderKey> borders, std::uint16_t tissues, float walk,
                           float reach) noexcept {
  const BorderKey* found = nullptr;
  const float end = walk + reach + kRamp;
  for (const BorderKey& border : borders) {
    if (border.walk > end) break;
    const float far = std::abs(border.walk - walk);
    if (border.tissues != tissues || far > reach) continue;
    reach = far;
    found = &border;
  }
  return found;
}

/// Least squares of y over x: a line, or a parabola through the points.
struct Curve {
  float n = 0.0F, x = 0.0F, xx = 0.0F, xxx = 0.0F, xxxx = 0.0F, y = 0.0F, xy = 0.0F, xxy = 0.0F;
  void add(float at, float value) noexcept {
    const float at2 = at * at;
    n += 1.0F;
    x += at;
    xx += at2;
    xxx += at2 * at;
    xxxx += at2 * at2;
    y += value;
    xy += at * value;
    xxy += at2 * value;
  }
  float slope() const noexcept {
    const float spread = n * xx - x * x;
    return spread > 1e-6F ? (n * xy - x * y) / spread : 0.0F;
  }
  float at_zero() const noexcept { return (y - slope() * x) / n; }
  /// Slope at zero and half of the second derivative of the parabola; false: too few points.
  bool bow(float& slope_at_zero, float& half_second) const noexcept {
    constexpr float kEnough = 4.0F;
    if (n < kEnough) return false;
    // About the mean: the products of the centred powers.
    const float xx_c = xx - x * x / n, xxx_c = xxx - xx * x / n, xxxx_c = xxxx - xx * xx / n;
    const float xy_c = xy - x * y / n, xxy_c = xxy - xx * y / n;
    const float spread = xx_c * xxxx_c - xxx_c * xxx_c;
    if (!(spread > 1e-3F * xx_c * xxxx_c)) return false;
    slope_at_zero = (xy_c * xxxx_c - xxy_c * xxx_c) / spread;
    half_second = (xxy_c * xx_c - xy_c * xxx_c) / spread;
    return true;
  }
};

float spacing_at(const ScanPlan& plan, const Border& border) noexcept {
  const double depth_mm = (static_cast<double>(border.walk) + 0.5) * static_cast<double>(plan.sample_mm);
  return static_cast<float>(plan.geometry.line_spacing_mm(std::max(depth_mm, 0.1)));
}

}  // namespace

SurfaceFit fit_in_plane(const ScanPlan& plan, const FrameState& frame, int plane, int line,
                        const Border& border) noexcept {
  const float spacing_mm = spacing_at(plan, border);
  const int wanted = std::max(1, static_cast<int>(kFitReach_mm / (kMostSteps * static_cast<double>(spacing_mm))));
  // Outer planes are not walked on every scanline.
  const int shift = plan.shift_of(plane);
  const int stride = (wanted + (1 << shift) - 1) >> shift << shift;
  const int walked = plan.walked_line(plane, line);
  const float step = (kSteepest * static_cast<float>(stride) * spacing_mm + kFitStep_mm) / plan.sample_mm;
  const std::uint16_t tissues = tissues_of(border);
  Curve along_face;
  along_face.add(static_cast<float>(walked - line) * spacing_mm, border.walk);
  for (const int side : {-1, 1}) {
    float walk = border.walk;
    for (int k = stride; k <= kMostSteps * wanted; k += stride) {
      const int other = walked + side * k;
      if (other < 0 || other >= plan.lines) break;
      const BorderKey* next = find_near(borders_of(plan, frame, plane, other), tissues, walk, step);
      if (next == nullptr) break;
      walk = next->walk;
      along_face.add(static_cast<float>(other - line) * spacing_mm, walk);
    }
  }
  SurfaceFit fit;
  fit.neighbours = static_cast<int>(along_face.n) - 1;
  fit.walk = fit.neighbours >= 2 ? along_face.at_zero() : border.walk;
  fit.lateral = along_face.slope() * plan.sample_mm;
  return fit;
}

SurfaceFit fit_surface(const ScanPlan& plan, const FrameState& frame, int plane, int line,
                       const Border& border) noexcept {
  SurfaceFit fit = fit_in_plane(plan, frame, plane, line, border);
  const std::uint16_t tissues = tissues_of(border);
  const auto at = static_cast<std::size_t>(std::clamp(static_cast<int>(border.walk), 0, plan.samples - 1));
  const float plane_mm = plan.plane_step * plan.elevation_sigma_mm[at];
  const float spacing_mm = spacing_at(plan, border);
  // Along the image, other planes may be walked on the scanline beside this one.
  const auto aside = [&](int other) {
    return fit.lateral * static_cast<float>(line - plan.walked_line(other, line)) * spacing_mm / plan.sample_mm;
  };
  const float here = border.walk + aside(plane);
  Curve across;
  for (int other = 0; other < plan.planes; ++other) {
    const float z_mm = static_cast<float>(other - plane) * plane_mm;
    const float reach = (kSteepest * std::abs(z_mm) + kFitStep_mm) / plan.sample_mm;
    if (other == plane)
      across.add(z_mm, here);
    else if (const BorderKey* next =
                 find_near(borders_of(plan, frame, other, line), tissues, here - aside(other), reach))
      across.add(z_mm, next->walk + aside(other));
  }
  float slope = across.slope(), half_second = 0.0F;
  across.bow(slope, half_second);
  fit.elevation = slope * plan.sample_mm;
  fit.bow_per_mm = half_second * plan.sample_mm;
  return fit;
}

}  // namespace trocar::ultrasound::detail
