#include "ultrasound/engine/detail/surface_echo.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "ultrasound/engine/detail/border_fit.h"
#include "ultrasound/engine/detail/tissue_walk.h"

namespace trocar::ultrasound::detail {
namespace {

/// Echo of a perfect, smooth, perpendicular reflector relative to liver's speckle, without attenuation: 48 dB (assumed;
/// range 40..60. Liver's backscatter makes it about 50 dB at 3.5 MHz).
constexpr float kPerfect = 250.0F;
/// Tilt at which the echo of a smooth surface has decreased to exp(-1/2), rad (assumed, range 0.1..0.35).
constexpr float kTilt_rad = 0.2F;
/// Echo share of a completely rough surface (assumed).
constexpr float kRoughShare = 0.22F;

std::uint32_t key_of(const std::array<float, 3>& index) noexcept {
  const auto part = [](float v, int shift) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(2.0F * v))) &
                                      0x1fffffU)
           << shift;
  };
  return static_cast<std::uint32_t>(mix64(part(index[0], 0) | part(index[1], 21) | part(index[2], 42)) >> 32);
}

/// Tilt of the surface relative to the wave front, rad.
float tilt_of(const ScanPlan& plan, const FrameState& frame, int line, const Border& border,
              const SurfaceFit& fit) noexcept {
  constexpr int kEnough = 3;
  if (fit.neighbours >= kEnough) return std::atan(std::hypot(fit.lateral, fit.elevation));
  // A small piece of a surface, or one nearly along the beam: from the volume.
  const LineWalk& path = frame.walks[static_cast<std::size_t>(line)];
  const Vec3 along = Vec3(path.along[0], path.along[1], path.along[2]).cwiseProduct(frame.scene->geometry.spacing_mm);
  const Vec3 slope = impedance_slope(frame, plan.rows, Vec3(border.index[0], border.index[1], border.index[2]));
  const double size = slope.norm();
  return size > 1e-6 ? static_cast<float>(std::acos(std::min(1.0, std::abs(slope.dot(along)) / size))) : 0.8F;
}

void note_reflector(Reflector& reflector, const Border& border, float shown, float strength, float smooth_share,
                    float rough, std::uint32_t key) noexcept {
  constexpr float kGas = -0.6F;
  const bool is_gas = border.reflection < kGas;
  if (is_gas ? reflector.is_gas : reflector.is_gas || strength * smooth_share <= reflector.amplitude) return;
  // Bubbles are rough gas; the smooth surface of the lung has no ring-down.
  constexpr float kBubbly = 0.35F;
  reflector = {shown, strength * smooth_share, strength * std::max(0.0F, rough - kBubbly), is_gas, key};
}

}  // namespace

void add_surface_echoes(const ScanPlan& plan, FrameState& frame, int line, int plane) noexcept {
  const auto at_line = static_cast<std::size_t>(line);
  const float* delay = frame.delay.data() + at_line * static_cast<std::size_t>(plan.samples);
  const auto first = static_cast<std::size_t>(plane * plan.lines + line);
  const bool is_central = plane == plan.planes / 2;
  if (is_central) frame.reflectors[at_line] = {};
  for (std::size_t b = 0; b < frame.border_counts[first]; ++b) {
    const Border& border = frame.borders[first * kMaxBorders + b];
    const float strength = std::abs(border.reflection) * std::exp(std::max(border.log_gain, -60.0F));
    constexpr float kInaudible = 1e-4F;  // about 30 dB below liver's speckle
    if (strength < kInaudible) continue;
    const SurfaceFit fit = fit_surface(plan, frame, plane, line, border);
    const auto at = static_cast<std::size_t>(std::clamp(fit.walk, 0.0F, static_cast<float>(plan.samples - 1)));
    const float shown = fit.walk + delay[at];
    const int sample = static_cast<int>(shown + 0.5F);
    if (shown < 0.0F || sample >= plan.samples) continue;
    const float tilt = tilt_of(plan, frame, line, border, fit);
    const float rough = std::max(plan.roughness[border.before & 127U], plan.roughness[border.behind & 127U]);
    const float smooth_share = (1.0F - rough) * std::exp(-0.5F * (tilt / kTilt_rad) * (tilt / kTilt_rad));
    const float amplitude =
        kPerfect * strength * plan.plane_weight[static_cast<std::size_t>(plane)] * plan.surface_scale[at];
    const std::uint32_t key = key_of(border.index);
    const float turn = 2.0F * std::numbers::pi_v<float> * static_cast<float>(key & 0xffffU) / 65536.0F;
    const float size_of_rough = std::sqrt(-std::log(std::max(static_cast<float>(key >> 16) / 65536.0F, 1e-4F)));
    // Rough echoes of adjacent scanlines and planes add up incoherently: each needs more amplitude for the same level.
    const float rough_part = rough * kRoughShare * std::cos(tilt) * size_of_rough / std::sqrt(plan.surface_scale[at]);
    const std::size_t to = plan.echo_row(line) + static_cast<std::size_t>(sample);
    frame.re[to] += amplitude * (smooth_share + rough_part * std::cos(turn));
    frame.im[to] += amplitude * rough_part * std::sin(turn);
    if (is_central) note_reflector(frame.reflectors[at_line], border, shown, strength, smooth_share, rough, key);
  }
}

}  // namespace trocar::ultrasound::detail
