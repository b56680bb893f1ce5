#include "ultrasound/detail/surface_echo.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace trocar::detail {
namespace {

/// Echo of a perfect, smooth, perpendicular reflector against liver's speckle, without attenuation: 48 dB (assumed;
/// range 40..60. Liver's backscatter makes it about 50 dB at 3.5 MHz).
constexpr float kPerfect = 250.0F;
/// Tilt at which a smooth surface's echo has fallen to exp(-1/2), rad (assumed, range 0.1..0.35).
constexpr float kTilt_rad = 0.2F;
/// What a wholly rough surface sends back of it (assumed).
constexpr float kRoughShare = 0.12F;

Vec3 gradient_mm(const FrameState& frame, const std::array<TissueRow, kTissues>& rows, const Vec3& index) noexcept {
  constexpr double kReach = 1.5;  // voxels
  Vec3 slope;
  for (int a = 0; a < 3; ++a) {
    double z[2];
    for (int side = 0; side < 2; ++side) {
      Vec3 p = index;
      p[a] += side == 0 ? -kReach : kReach;
      z[side] = static_cast<double>(
          blend_at(frame, rows, static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()))
              .row.log_z);
    }
    slope[a] = (z[1] - z[0]) / frame.scene->geometry.spacing_mm[a];
  }
  return slope;
}

std::uint32_t key_of(const Vec3& index) noexcept {
  const auto part = [](double v, int shift) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(2.0 * v))) &
                                      0x1fffffU)
           << shift;
  };
  return static_cast<std::uint32_t>(mix64(part(index.x(), 0) | part(index.y(), 21) | part(index.z(), 42)) >> 32);
}

}  // namespace

void add_surface_echoes(const ScanPlan& plan, FrameState& frame, const WalkResult& walk, int line, int plane) noexcept {
  const AcousticScene& scene = *frame.scene;
  const auto at_line = static_cast<std::size_t>(line);
  const LineWalk& path = frame.walks[at_line];
  const Vec3 spacing = scene.geometry.spacing_mm;
  const Vec3 along = Vec3(path.along[0], path.along[1], path.along[2]).cwiseProduct(spacing);
  const float* delay = frame.delay.data() + at_line * static_cast<std::size_t>(plan.samples);
  Reflector& reflector = frame.reflectors[at_line];
  const bool is_central = plane == plan.planes / 2;
  if (is_central) reflector = {};
  for (int b = 0; b < walk.border_count; ++b) {
    const Border& border = walk.borders[static_cast<std::size_t>(b)];
    const int s = std::clamp(static_cast<int>(border.walk), 0, plan.samples - 1);
    const auto at = static_cast<std::size_t>(s);
    const Vec3 index(walk.index[0][at], walk.index[1][at], walk.index[2][at]);
    const Vec3 slope = gradient_mm(frame, plan.rows, index);
    const double size = slope.norm();
    const float facing = size > 1e-6 ? static_cast<float>(std::min(1.0, std::abs(slope.dot(along)) / size)) : 0.7F;
    const float tilt = std::acos(facing);
    const float rough = std::max(plan.roughness[border.before & 127U], plan.roughness[border.behind & 127U]);
    const float smooth_part = (1.0F - rough) * std::exp(-0.5F * (tilt / kTilt_rad) * (tilt / kTilt_rad));
    const float amplitude = kPerfect * std::abs(border.reflection) * std::exp(std::max(border.log_gain, -60.0F)) *
                            plan.plane_weight[static_cast<std::size_t>(plane)] * plan.surface_scale[at];
    const std::uint32_t key = key_of(index);
    const float turn = 2.0F * std::numbers::pi_v<float> * static_cast<float>(key & 0xffffU) / 65536.0F;
    const float size_of_rough = std::sqrt(-std::log(std::max(static_cast<float>(key >> 16) / 65536.0F, 1e-4F)));
    // Rough echoes of neighbouring scanlines and planes add up in disorder: more of each is needed for the same level.
    const float rough_part = rough * kRoughShare * facing * size_of_rough / std::sqrt(plan.surface_scale[at]);
    const float shown = border.walk + delay[at];
    const int sample = static_cast<int>(shown + 0.5F);
    if (sample < 0 || sample >= plan.samples) continue;
    const std::size_t to = at_line * static_cast<std::size_t>(plan.stride) + kPad + static_cast<std::size_t>(sample);
    frame.re[to] += amplitude * (smooth_part + rough_part * std::cos(turn));
    frame.im[to] += amplitude * rough_part * std::sin(turn);
    if (is_central) {
      const float strength = std::abs(border.reflection) * std::exp(std::max(border.log_gain, -60.0F));
      const float smooth_strength =
          strength * std::exp(-0.5F * (tilt / kTilt_rad) * (tilt / kTilt_rad)) * (1.0F - rough);
      const bool is_gas = border.reflection < -0.6F;
      if (is_gas ? !reflector.is_gas : smooth_strength > reflector.amplitude && !reflector.is_gas)
        reflector = {shown, smooth_strength, strength * rough, is_gas, key};
    }
  }
}

}  // namespace trocar::detail
