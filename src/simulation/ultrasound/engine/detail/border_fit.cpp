#include "ultrasound/engine/detail/border_fit.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace trocar::ultrasound::detail {
namespace {

constexpr double kReach_mm = 3.0;  ///< To each side: several voxels, and less than the curvature radius of most organs.
constexpr int kMostSteps = 4;      ///< Scanlines to each side.
constexpr float kSteepest = 1.7F;  ///< Largest slope followed from line to line,
constexpr float kRamp = 16.0F;     ///< Samples.
constexpr float kStep_mm = 1.2F;   ///< in addition to the step of a voxel.

std::span<const BorderKey> borders_of(const ScanPlan& plan, const FrameState& frame, int plane, int line) noexcept {
  const auto at = static_cast<std::size_t>(plane * plan.lines + line);
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

/// Least squares of y over x.
struct Line {
  float n = 0.0F, x = 0.0F, y = 0.0F, xx = 0.0F, xy = 0.0F;
  void add(float at, float value) noexcept {
    n += 1.0F;
    x += at;
    y += value;
    xx += at * at;
    xy += at * value;
  }
  float slope() const noexcept {
    const float spread = n * xx - x * x;
    return spread > 1e-6F ? (n * xy - x * y) / spread : 0.0F;
  }
  float at_zero() const noexcept { return (y - slope() * x) / n; }
};

}  // namespace

SurfaceFit fit_in_plane(const ScanPlan& plan, const FrameState& frame, int plane, int line,
                        const Border& border) noexcept {
  const double depth_mm = (static_cast<double>(border.walk) + 0.5) * static_cast<double>(plan.sample_mm);
  const auto spacing_mm = static_cast<float>(plan.geometry.line_spacing_mm(std::max(depth_mm, 0.1)));
  const int stride = std::max(1, static_cast<int>(kReach_mm / (kMostSteps * static_cast<double>(spacing_mm))));
  const float step = (kSteepest * static_cast<float>(stride) * spacing_mm + kStep_mm) / plan.sample_mm;
  const std::uint16_t tissues = tissues_of(border);
  Line along_face;
  along_face.add(0.0F, border.walk);
  for (const int side : {-1, 1}) {
    float walk = border.walk;
    for (int k = stride; k <= kMostSteps * stride; k += stride) {
      const int other = line + side * k;
      if (other < 0 || other >= plan.lines) break;
      const BorderKey* next = find_near(borders_of(plan, frame, plane, other), tissues, walk, step);
      if (next == nullptr) break;
      walk = next->walk;
      along_face.add(static_cast<float>(side * k) * spacing_mm, walk);
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
  const std::uint16_t tissues = tissues_of(border);
  Line across;
  const auto at = static_cast<std::size_t>(std::clamp(static_cast<int>(border.walk), 0, plan.samples - 1));
  const float plane_mm = plan.plane_step * plan.elevation_sigma_mm[at];
  for (int other = 0; other < plan.planes; ++other) {
    const float z_mm = static_cast<float>(other - plane) * plane_mm;
    const float reach = (kSteepest * std::abs(z_mm) + kStep_mm) / plan.sample_mm;
    if (other == plane)
      across.add(z_mm, border.walk);
    else if (const BorderKey* next = find_near(borders_of(plan, frame, other, line), tissues, border.walk, reach))
      across.add(z_mm, next->walk);
  }
  SurfaceFit fit = fit_in_plane(plan, frame, plane, line, border);
  fit.elevation = across.slope() * plan.sample_mm;
  return fit;
}

}  // namespace trocar::ultrasound::detail
